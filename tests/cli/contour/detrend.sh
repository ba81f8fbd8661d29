# An offset hides the rings of a recording behind those of its ends; a trend that is subtracted does not, in each form
# of file, as ss-morlet subtracts it.
ss-sim compliant-light | ss-cat --column a -o plain.tsv
awk '/^#/ { print; next } { $2 += 9.81; print }' FS='\t' OFS='\t' plain.tsv > offset.tsv
awk '/^#/ { print; next } { $2 += 9.81 + NR / 500; print }' FS='\t' OFS='\t' plain.tsv > ramp.tsv
level() { ss-contour -q "$@" | sed -n 's/^level = *\([-0-9.]*\) .*/\1/p'; }
near() { awk -v a="$1" -v b="$2" -v by="$3" 'BEGIN { exit !(a - b < by && b - a < by) }' || echo "$1 is not $2: $4"; }
plain=$(level plain.tsv)
awk -v a="$(level offset.tsv)" -v b="$plain" 'BEGIN { print (a > b + 10 ? "an offset hides it" : a) }'
for file in offset ramp; do
    ss-cat $file.tsv -o $file.au
    ss-cat $file.tsv -o $file.h5
    ss-cat $file.tsv -o $file.csv
    for how in mean linear; do
        ss-morlet -q --detrend=$how --fmin 1 $file.tsv -o w.h5
        whole=$(level w.h5)
        for form in tsv au h5 csv; do near "$(level --detrend=$how --fmin 1 $file.$form)" "$whole" .02 "$file.$form $how"; done
    done
done
near "$(level --detrend=mean offset.tsv)" "$plain" 1 'offset, mean'
near "$(level --detrend=linear ramp.tsv)" "$plain" 1 'ramp, line'
ss-contour --detrend mean w.h5 -o no.gp || echo $?
# A constant has nothing left.
ss-signal sine --duration 4 | awk '!/^#/ { $2 = 9.81 } { print }' FS='\t' OFS='\t' > constant.tsv
ss-contour --detrend linear constant.tsv | grep -c '^level ' || true
ls ./*.gp 2> /dev/null || true
