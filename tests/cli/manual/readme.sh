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
ss-morlet --rate 2000 --column force -o untimed.h5 untimed.csv
ss-features --from 2 --to 3 --column force --scale 250 --unit N run.csv | grep '^# calibration'
ss-features -c accel run.csv > f.tsv
ss-features -c accel --format csv run.csv > f.csv
if command -v python3 > /dev/null; then
    python3 -c 'import csv; r = [float(x["prominence"]) for x in csv.DictReader(open("f.csv")) if x["prominence"]]; print(sum(r) / len(r))'
else
    awk -F , 'NR == 1 { for (i = 1; $i != "prominence"; i++); next } $i != "" { s += $i; n++ } END { printf "%.14g\n", s / n }' f.csv
fi > mean
awk '/^# columns/ { for (i = 3; $i !~ /^prominence/; i++); k = i - 2 } !/^#/ && $k != "-" { s += $k; n++ } END { print s / n }' f.tsv |
    paste - mean | awk '{ d = $1 - $2; print "mean of the prominence:", d * d < 1e-6 * $1 * $1 ? "the same" : $0 }'
# The same by each of the programs that are there.
! python3 -c 'import pandas' 2> none ||
    python3 -c 'import pandas; assert abs(pandas.read_csv("f.csv")["prominence"].mean() / float(open("mean").read()) - 1) < 1e-12'
! command -v Rscript > none || Rscript -e 'stopifnot(is.numeric(read.csv("f.csv")$prominence))'
! command -v mlr > none || mlr --icsv --opprint stats1 -a mean -f prominence f.csv | grep -q prominence_mean
rm -f none mean f.csv f.tsv
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
