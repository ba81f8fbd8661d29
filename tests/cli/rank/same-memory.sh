# What malloc leaves in memory changes no number, nor does it in a fit from a start of its own.
awk 'BEGIN { print "t_s,x"; for (i = 0; i < 2000; i++) printf "%.3f,%.6f\n", i / 500, sin(2 * 3.141592653589793 * i / 100) }' > run.csv
ss-sim state-variable > rig.tsv
for byte in 1 85 200; do
    for file in run.csv rig.tsv; do
        MALLOC_PERTURB_=$byte ss-rank -q --long --as x -c x $file > $file.$byte
        cmp $file.1 $file.$byte
    done
done
grep -c '^[-1-9]' run.csv.85 rig.tsv.85
