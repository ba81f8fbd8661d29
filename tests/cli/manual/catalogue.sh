# The examples of stickslip-catalogue(7), and the numbers that its text states.
command -v gnuplot > /dev/null || { echo "no gnuplot"; exit 77; }
rows() { grep -v '^#' | awk -F '\t' '{ for (i = 2; i < NF; i++) printf "%.6f ", $i; print $NF }'; }
gaps() {        # of the events: how long each lasts, from the third on
    grep -v '^#' | awk -F '\t' 'NR > 3 { printf "%s %.6f\n", kind, $1 - t } { t = $1; kind = $2 }' | sort -u
}
ss-sim --list | grep -c -e chaos -e hartog -e decay -e leine -e pulled -e rate-and -e shaw -e subharmonic
ss-sweep --measure stops,amplitude --vary friction=0.5:0.5:1 den-hartog | rows
ss-sweep --measure stops,stick,amplitude,floquet --vary friction=0.9:0.9:1 den-hartog-stops | rows
ss-sim --events pulled-slider | gaps
ss-sim --events leine | gaps
ss-sim --events free-decay | awk -F '\t' '!/^#/ { n++; last = $3 } END { printf "%d %.6f\n", n - 1, last }'
ss-sweep --measure stops,amplitude,x_max,x_phase,floquet --vary x0=-2:2:2 shaw | rows
ss-sweep --measure amplitude,x_max,floquet --vary x0=1.15:1.5:8 subharmonic | rows
ss-sweep --measure period,lyapunov,lyapunov_error --vary base_frequency=0.52:0.7:10 chaos |
    awk -F '\t' '!/^#/ { printf "%.2f %s %.1f\n", $2, $3, $4 }'
ss-sweep --measure stops,amplitude,x_max,floquet --vary base_frequency=0.458:0.462:5 shaw | rows
ss-sim -c t,s pulled-slider | ss-plot -o slider.png
ss-sim -c t,x,v leine | ss-plot --xy x,v -o leine.png
ss-sim -c t,x,v shaw | ss-plot --xy x,v -o shaw.png
ss-sweep --measure cycle_time,peak_velocity,force_drop,growth --vary stiffness=1000:2000:3 rate-and-state-mild | rows
ss-sweep --measure growth --vary stiffness=49500:50600:12 rate-and-state-lab | rows
ss-sim -c t,s -s settle=100 -s duration=200 -s rate=200 rate-and-state-lab | ss-features |
    awk 'BEGIN { truth["drop:"] = 14.9026635; truth["recurrence_time:"] = 15.22062821; truth["loading_slope:"] = 1 }
        $2 in truth { print $2, ($3 - truth[$2]) ^ 2 < $4 ^ 2 }'
ss-sim -c v,f -s settle=60 -s duration=16 -s rate=5000 --format csv rate-and-state-lab |
    awk -F, 'NR == 1 { print "lnV,mu"; next } { print log($1) "," $2 / 100 }' |
    ss-plot --rate 5000 --xy lnV,mu -o plane.png
for picture in slider leine shaw plane; do [ -s $picture.png ] || echo "no picture of $picture"; done
