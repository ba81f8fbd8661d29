# Several files give a table: the numbers of each file alone, and their scatter.
for seed in 1 2 3; do ss-sim compliant-light | ss-noise --snr 30 --seed $seed > run$seed.tsv; done
ss-sim compliant-heavy > heavy.tsv
awk 'BEGIN { print "t_s,force_N"
    for (i = 0; i < 4000; i++) printf "%.3f,%.6f\n", i / 1000, 5 + (i % 200) / (i % 200 < 190 ? 100 : 10 + 9 * (i % 200)) + sin(i * i) / 1000 }' > saw.csv
awk -F, 'NR == 1 { print "t_s,force_mN"; next } { print $1 "," 1000 * $2 }' saw.csv > saw-m.csv
: > empty.csv
files='run1.tsv empty.csv run2.tsv heavy.tsv none.csv run3.tsv saw.csv saw-m.csv'
ss-features --mass 2.42 $files > table 2> said && echo "status $?"
cat said
# each cell is the number of the file alone
value() { awk -F '\t' -v file="$2" -v key="$1" '/^# columns/ { sub(/^# columns: /, ""); gsub(/\/\([^)]*\)|\/[^ ]*/, "")
    n = split($0, name, " "); for (i in name) if (name[i] == key) c = i } $1 == file { print $c }' table; }
for file in run1.tsv run2.tsv heavy.tsv run3.tsv saw.csv; do
    ss-features --mass 2.42 $file | sed -n 's/^# \([a-z_]*\): \([-0-9][^ ]*\) \([-0-9][^ ]*\)\( [^ ]*\)*$/\1 \2 \3/p' > alone
    [ "$(wc -l < alone)" -ge 8 ] || echo "$file: few numbers"
    while read -r key number error; do
        [ "$(value "$key" $file) $(value "${key}_error" $file)" = "$number $error" ] || echo "$file: $key differs"
    done < alone
done
value reason empty.csv
value reason none.csv
value reason run1.tsv
value slip_rate empty.csv
# scatter, computed in another way
for key in transition_frequency damping_ratio; do
    for file in run1.tsv run2.tsv heavy.tsv run3.tsv; do
        echo "$(value $key $file) $(value ${key}_error $file)"
    done | awk '{ x[NR] = $1; m += $1 / 4; e += $2 ^ 2 / 4 } END { for (i = 1; i <= 4; i++) s += (x[i] - m) ^ 2 / 3
        printf "%.9e %.9e %.9e 4\n", m, sqrt(s), sqrt(e) }' > wanted
    awk -v key="# $key:" 'index($0, key) == 1 { printf "%.9e %.9e %.9e %s\n", $3, $4, $5, $6 }' table | diff wanted -
done
# newtons and millinewtons have no mean
value unit saw.csv
value unit saw-m.csv
grep '^# loading_slope: ' table
# whatever the number of jobs; in CSV; by one file or standard input as before
ss-features --mass 2.42 --jobs 3 -o jobs.tsv $files 2> said3 && cmp jobs.tsv table && cmp said3 said
ss-features --mass 2.42 -j 100 --format csv $files 2> /dev/null > table.csv
awk -F, 'NR == 1 { n = NF; print $1, $3, n } NF < n { print "short:", $0 } END { print NR }' table.csv
ss-features run1.tsv run2.tsv - < run3.tsv | grep -c '^[r-]'
ss-features run1.tsv > one && ss-features < run1.tsv | cmp - one
# the row of one file is that of several
for file in run2.tsv saw.csv; do ss-features --mass 2.42 --summary $file | grep '^[rs]' >> rows; done
grep -E '^(run2.tsv|saw.csv)' table | cmp - rows
ss-features --summary < run1.tsv | grep -c '^-'
# a row never looks like a note
cp run1.tsv '#1.tsv'
ss-features --summary '#1.tsv' | grep -c '^\./#1\.tsv	'
# nothing at all is read
ss-features empty.csv none.csv > nothing 2> /dev/null || echo "status $?"
grep -vc '^#' nothing
ss-features run1.tsv run2.tsv -o run2.tsv || echo "status $?"
ss-features --jobs 0 run1.tsv || echo "status $?"
ss-morlet --dyadic run1.tsv -o c.tsv
ss-contour --features table c.tsv || echo "status $?"
