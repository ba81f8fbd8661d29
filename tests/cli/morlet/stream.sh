# The stream of coefficients: header, grid, cone of influence, and a tone where it belongs: away from
# the ends |W| is sqrt(2 pi)/2 pi^-1/4 exp(-(80 pi a - 6)^2/2).
ss-signal sine --duration 4 --frequency 40 | ss-morlet --dyadic --norm l1 --detrend mean > c.tsv
grep '^#' c.tsv
grep -v '^#' c.tsv | awk -F '\t' '
    $2 != 2 ^ $1 || $3 != n[$1] * $2 || NF != 7 { print "off the grid: " $0 }
    ($3 < sqrt(2) * $2 || 3.9995 - $3 < sqrt(2) * $2) != $7 { print "wrong edge: " $0 }
    { n[$1]++; w = sqrt($5 ^ 2 + $6 ^ 2); if ($3 > 1 && $3 < 3 && w > top[$1]) top[$1] = w }
    END {
        for (m = -1; m >= -9; m--) print m, n[m]
        for (m = -4; m >= -7; m--) {
            want = 0.941395 * exp(-(80 * 3.14159265358979 * 2 ^ m - 6) ^ 2 / 2)
            if ((top[m] - want) ^ 2 > 4e-12) print m, top[m], want
        }
    }'
ss-signal sine --duration 1 | ss-morlet --dense --fmin 20 --fmax 21 | awk '!/^#/' | wc -l | tr -d ' '
