# spikes.gp -- micro-slips seen against their length, for each signal-to-noise ratio:
#   build/tests/bench/bench_spikes --slips > slips && gnuplot -e 'slips="slips"' man/figures/spikes.gp > spikes.png
set terminal pngcairo size 540,400 font ',11'
set xlabel 'length of the micro-slip / ms'; set ylabel 'micro-slips seen / %'
set xrange [0:5]; set yrange [-3:103]; set grid lc rgb '#dddddd' lt 1
set key outside right center title 'SNR / dB' reverse Left
set tics nomirror out; set border 3
set palette defined (0 '#440154', 0.4 '#2a788e', 0.7 '#22a884', 1 '#9bd93c')
unset colorbox
snr = '60 50 45 40 35 30 25 20'
plot for [i=0:7] slips index i using 2:3 with linespoints pt 7 ps 0.7 lw 1.8 lc palette frac i/7. title word(snr, i+1)
