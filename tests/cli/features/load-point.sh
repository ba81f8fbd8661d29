# Beside the path of a load point, ss-rank is named.
ss-sim -c t,s,z pulled-slider | sed '/^#/s/z\/m/load\/m/' > pulled.tsv
ss-features --column s pulled.tsv > numbers
grep -c '^# drop' numbers
ss-features -q --column s pulled.tsv | cmp - numbers
# each fall has its own numbers, by the names of the manual
ss-sim -c t,s,z pulled-slider | ss-noise --snr 60 | ss-features --column s --displacement z > rows
for truth in slope=0.007056 stiffness=168 drop=0.03 static_friction=0.0602 friction=0.0452 k_over_m=5472.3127; do
    awk -v name="${truth%=*}" -v truth="${truth#*=}" '
        $2 == "columns:" { for (i = 3; i <= NF; i++) { sub(/\/.*/, "", $i); if ($i == name) at = i - 2 } }
        !/^#/ { n++; near += ($at - truth)^2 < 25 * $(at + 1)^2 }
        END { print name, (at > 0 && n > 4 && near == n) }' rows
done
