# The options of reading: units of time, words among numbers, one of several tables, a factor and a unit; in every
# tool that reads a signal.
refused() { "$@" || echo $?; }
awk 'BEGIN { print "label,ms,f (V)"; for (i = 0; i < 2000; i++) printf "ok,%g,%.4f\n", i / 2, sin(i * 0.6) }' > run.csv
ss-cat --to 0.001 run.csv
ss-cat --time ms --scale 250 --unit N -c f --from 0.5 --to 0.501 run.csv
ss-cat --scale f=250 --to 0.0005 run.csv
awk 'BEGIN { print "time,f"; for (i = 0; i < 2000; i++) printf "%g,%.4f\n", i / 2, sin(i * 0.6) }' > unknown.csv
ss-cat unknown.csv | sed -n 2p
ss-cat --time-unit ms unknown.csv | sed -n 2p
refused ss-cat --time-unit min --rate 3 unknown.csv
refused ss-cat --time-unit day unknown.csv
printf 'us,f\n0,1\n1e11,2\n' | refused ss-cat
{ printf 'Step 1\nt,Fx\nsec,N\n0,1\n0.001,2\nStep 2\n'; sed 's/ms,f (V)/t_ms,f/; s/^ok,//; s/^label,//' run.csv; } > steps.csv
refused ss-cat steps.csv
ss-cat --table 1 steps.csv
refused ss-cat --table 3 steps.csv
# All of them read the same.
ss-cat -q --table 2 --scale f=2 --from 0.1 steps.csv > ready.tsv
options='--table 2 --scale f=2 --from 0.1'
for tool in 'ss-noise --rms 1' ss-morlet 'ss-morlet --stream --fmin 20' 'ss-features -q' 'ss-rank -q --as a'; do
    # shellcheck disable=SC2086  # options are a list
    $tool $options steps.csv > one
    $tool ready.tsv > two
    grep -v '^# signal_name' one > one.body
    grep -v '^# signal_name' two > two.body
    cmp one.body two.body && echo "$tool: the same"
done
ss-trade -q -b 0.01 --table 2 steps.csv | grep '^# compared'
ss-morlet ready.tsv -o c.tsv
ss-contour --signal steps.csv --table 2 --scale 2 --from 0.1 c.tsv | sed -n 's/.*\(set yrange.*f.*\)/\1/p' | head -n 1
ss-plot --table 2 --from 0.1 steps.csv > plot.gp
ss-cat --table 2 steps.csv | ss-plot --from 0.1 > two.gp
cmp plot.gp two.gp
# HDF5 has a clock of its own; it is cut and calibrated as well.
ss-cat -o run.h5 ready.tsv
ss-cat --from 0.2 --to 0.2005 --scale 0.5 run.h5
refused ss-cat --from 7 run.h5
refused ss-cat --scale nix=2 run.h5

echo "-- two time stamps far apart claim no memory"
printf 't,a\n0,1\n0.001,2\n0.0021,3\n9999999,4\n' > far.csv
ss-cat --time-unit s --resample 100 far.csv 2>&1 || echo "exit $?"
