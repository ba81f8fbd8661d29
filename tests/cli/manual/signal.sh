# The EXAMPLES of ss-cat(1), ss-signal(1), ss-noise(1) and stickslip-signal(5).
awk 'BEGIN { print "t,x,f"; for (i = 0; i < 500; i++) print i / 100 "," i "," 2 * i }' > run.csv
ss-cat -c x -c f --from 2 --to 3 run.csv | tail -n 1
ss-cat -c x -c f --from 2 --to 3 run.csv | grep -c -v '^#'
ss-signal impulse --at 5 > impulse.tsv
grep -v '^#' impulse.tsv | awk '$2 != 0'
ss-signal ringdown | ss-noise --snr 40 | sed -n 2p
ss-signal ringdown | ss-noise --rms 0.01 --band 45:160 |
    ss-noise --bits 12 --range 2 | sed -n -e 2,3p -e 7p
ss-cat run.csv | awk '!/^#/ { print $1, $2 }' | tail -n 1
awk 'BEGIN { print "t,x"; for (i = 0; i < 500; i++) if (i < 100 || i > 160) print (i + 0.3 * sin(i)) / 1000 "," i }' > log.csv
ss-cat --resample 1000 --gaps interpolate -o even.tsv log.csv
grep gaps even.tsv
