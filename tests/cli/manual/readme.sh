# The README's walk, with a recording made here: semicolons, decimal commas, a units row.
command -v gnuplot > /dev/null || { echo "no gnuplot"; exit 77; }
ss-sim --columns t,a,f compliant-light | awk 'BEGIN { print "time;accel;force\ns;m/s^2;N" }
    !/^#/ { gsub("\t", ";"); gsub("[.]", ","); print }' > run.csv
ss-cat run.csv | head | grep columns
ss-plot run.csv -o run.png
ss-morlet --column force --detrend mean run.csv -o run.h5
ss-contour run.h5 -o contour.png
ss-features --column force run.csv -o features.tsv
ss-contour --features features.tsv run.h5 -o marked.png
cut -d ';' -f 2,3 run.csv > untimed.csv
ss-cat --rate 2000 untimed.csv | ss-morlet --column force -o untimed.h5
ss-cat --from 2 --to 3 run.csv | ss-morlet --column force -o part.h5
ss-sim --set mass=1.8 --set contact_damping=40 compliant-heavy | ss-morlet -o model.h5
ss-contour model.h5 -o model.png
ss-sim --events compliant-heavy | tail | cut -f 2 | sort | uniq -c | tr -s " "
ss-sim compliant-heavy | ss-noise --snr 40 > accel.tsv      # one to try
ss-rank accel.tsv | awk '!/^#/ { print $1, $2 }'
ss-rank --fit accel.tsv > mine.scene && ss-sim mine.scene | ss-morlet -o mine.h5
ss-sim compliant-light | ss-features --mass 2.42 --stiffness 2310 |
    awk '/^# (transition_frequency|total_stiffness|contact_stiffness):/ { printf "%s %.6g\n", $2, $3 }'
ss-sim compliant-light | ss-morlet -o light.h5 && ss-contour light.h5 -o light.png
ls
