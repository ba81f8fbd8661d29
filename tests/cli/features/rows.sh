# Rows and summary of ss-features, and the examples of its manual.
ss-sim compliant-light > run.tsv
ss-features --mass 2.42 --stiffness 2310 run.tsv > found
head -n 1 found
grep '^# columns' found
grep -vc '^#' found
grep -v '^#' found | awk 'NF != 10 || $3 != 3 || $5 < 44 || $5 > 48 || $7 < 47.1 || $7 > 47.14 { print "odd:", $0 }'
sed -n 's/^# \([a-z_]*\): [-0-9.e]* [-0-9.e]*$/\1/p' found | sed -n '/^transitions$/,$p'
awk '$2 == "contact_stiffness:" && ($3 < 209850 || $3 > 209950) { print "odd:", $0 }' found
ss-features -o out.tsv run.tsv && ss-features -o - --mass 2.42 --stiffness 2310 < run.tsv | cmp - found
# a gap before the end of the fourth stick: nothing is counted there, and nothing else changes but last digits
awk 'BEGIN { print "t,a" } !/^#/ { print $1 "," ($1 >= 0.725 && $1 < 0.73 ? "" : $4) }' run.tsv |
    ss-cat --gaps interpolate | ss-features > gap
grep '_*gaps: ' gap
grep -v '^#' gap | awk '$3 != 3 { print "spikes", $3, "from", int($1 * 100) / 100 }'
for f in found gap; do grep -v '^#' $f | awk '$3 == 3 { printf "%.6f %.6f %.2f %.6f\n", $1, $2, $4, $7 }' > $f.rows; done
grep -vxFf found.rows gap.rows || echo "others as without"
# a table that has no notes has the summary in each row, and a row for it where there is no transition
for from in 'ss-cat run.tsv' 'ss-signal sine'; do $from | ss-features --format csv | awk -F, '{ n = NF } END { print NR, n }'; done
# nothing there
ss-signal noise --duration 2 | ss-features | sed -n '/^# transitions/,$p'
# the manual
ss-sim compliant-light | ss-noise --snr 40 | ss-features --mass 2.42 --stiffness 2310 | grep stiffness | wc -l
ss-sim compliant-heavy | ss-morlet -o run.h5
ss-features run.h5 -o run.tsv
ss-contour --features run.tsv run.h5 -o run.gp
grep -c feature_colour run.gp
# a file of coefficients is asked about the column that they are of
ss-sim compliant-light | ss-morlet -c f -o force.h5
ss-features force.h5 | grep '^# column:'
# wrong usage, bad data
for wrong in '--threshold=0' '--stiffness=1' '--norm=l3' '--drop=-1'; do
    ss-features $wrong run.h5 2>> said && echo taken || echo $?
done
cat said
ss-features --column nothing run.h5 || echo $?
# a mass that leaves nothing to the contact
ss-sim compliant-light | ss-features --mass 1e-9 --stiffness 2310 2>&1 > /dev/null |
    sed 's/[0-9.e-]* N\/m/? N\/m/'
