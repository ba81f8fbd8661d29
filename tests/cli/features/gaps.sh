# Coefficients near a gap are flagged like those near the ends, in every form, and read back so.
awk 'BEGIN { print "t,a"; for (i = 0; i < 1000; i++) if (i < 500 || i >= 540) print i / 500 "," sin(i) }' > run.csv
ss-morlet run.csv 2> refused || echo "refused, exit $?"
ss-cat --gaps split run.csv -o run.tsv
ss-morlet --fmin 5 --dense run.tsv -o w.tsv
# a and b of a coefficient tell: nearer than sqrt(2) a to an end or to [1, 1.08).
awk '/^#/ { next } { c = sqrt(2) * $2; want = $3 < c || 1.998 - $3 < c || ($3 > 1 - c && $3 < 1.08 + c)
    if (want != $7) wrong++; edge += $7; n++ } END { print wrong + 0, (edge > 0 && edge < n) }' w.tsv
# the shaded area reaches the top at both ends and at the gap
ss-contour w.tsv | awk '/^fmax = / { top = $3 } /cone << EOD/ { inside = 1; next } inside && /^EOD/ { print times; exit }
    inside { up = $2 > 0.999 * top; times += up && !before; before = up }'
ss-morlet --fmin 5 --dense --exact-bits run.tsv -o w.h5
ss-contour --title x --signal run.tsv w.tsv > one.gp
ss-contour --title x --signal run.tsv w.h5 > two.gp
cmp one.gp two.gp
sed "/^#/!s/1\$/0/" w.tsv > forged.tsv
ss-contour --title x --signal run.tsv forged.tsv | cmp - one.gp         # edges are computed, not believed
