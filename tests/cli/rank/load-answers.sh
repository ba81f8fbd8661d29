# A step of rate and state, integrated by awk: a .006, b .009, Dc 8 um, k 1500 /m, with noise of 2e-5.
awk 'BEGIN { a = .006; b = .009; Dc = 8; k = 1.5e-3; seed = 1; print "time (s),load (um),mu,shear (MPa),normal (MPa)"
    for (i = 0; i < 700; i++) {
        t = i < 300 ? i / 2 : 150 + (i - 300) / 10
        x = t < 150 ? t : 150 + 10 * (t - 150)
        for (j = 0; i > 0 && j < 400; j++) {
            h = (t - before) / 400; V = exp(u); f = (exp(-w) - V) / Dc; g = k / a * ((t > 150 ? 10 : 1) - V) - b / a * f
            w1 = w + h / 2 * f; u1 = u + h / 2 * g
            V = exp(u1); f = (exp(-w1) - V) / Dc; g = k / a * ((t > 150 ? 10 : 1) - V) - b / a * f
            w += h * f; u += h * g
        }
        before = t; noise = 0
        for (j = 0; j < 4; j++) { seed = (seed * 16807) % 2147483647; noise += seed / 2147483647 - .5 }
        mu = .6 + a * u + b * w + 2e-6 * x + 2e-5 * noise
        printf "%.6f,%.9f,%.9f,%.9f,50\n", t, x, mu, 50 * mu
    } }' > step.csv
show() { awk -F '[ :]+' '/answer/ { print $3 } /_effect:|_distance:|stiffness:|drift:/ { printf "%s %.2g\n", $2, $3 }'; }
ss-rank --load load --column mu step.csv -o rows.tsv
show < rows.tsv
head -n 1 rows.tsv
grep columns rows.tsv
grep -v '#' rows.tsv | cut -f 1,2
# The same of a shear stress, of a stiffness that is given, in other units and of a part.
ss-rank --load load --column shear --normal-stress normal step.csv | show
ss-rank --load load --column mu --set stiffness=1500 step.csv | grep stiffness:
ss-rank --load load --column mu --scale load=1e-3 --unit load=mm step.csv | show
ss-rank --load load --column mu --from 50 --to 180 --format csv step.csv | cut -d , -f 1,2
# Friction that is a line but for noise, and a step under noise as large as it: the answer, and only a reason.
for mu in .6 '$3'; do
    awk -F , -v OFS=, 'BEGIN { seed = 3 } NR > 1 { seed = (seed * 16807) % 2147483647; $3 = '"$mu"' + .02 * (seed / 2147483647 - .5) } 1' \
        step.csv | ss-rank --load load --column mu | awk -F ': ' '/^# answer/ { print $2 }'
done
# Drawn: path, friction, and of each law its friction and what it leaves, of which the right one leaves less.
ss-rank --load load --column mu step.csv -o step.gp
grep -c '^\$step' step.gp
awk '/^[$]step0/ { on = 1; next } /^EOD/ { on = 0 }
    on { n++; path = $1
         for (k = 3; k < 6; k += 2) { d = $2 - $k; l = $(k + 1); dd[k] += d * d; ll[k] += l * l; dl[k] += d * l } }
    END { print (n > 200), (path > 540 && path < 549.1), (dl[3] > .9 * sqrt(dd[3] * ll[3])),
              (dl[5] > .9 * sqrt(dd[5] * ll[5])), (ll[3] < ll[5]) }' step.gp
