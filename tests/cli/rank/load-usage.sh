# A load point without a step, or with wrong options, is one line and no rows.
awk 'BEGIN { print "time (s),load (um),mu,p (MPa)"; for (i = 0; i < 100; i++) print i "," i ",.6,1" }' > flat.csv
ss-rank --load load --column mu flat.csv || echo $?
ss-rank --share --load load --column mu flat.csv || echo $?
ss-rank --load mu --column load flat.csv || echo $?
ss-rank --load load --column load flat.csv || echo $?
ss-rank --load load --column p flat.csv || echo $?
ss-rank --load load --column mu --normal-stress p flat.csv || echo $?
ss-rank --load absent --column mu flat.csv || echo $?
ss-rank --load load --column mu --fit flat.csv || echo $?
ss-rank --load load --column mu --set mass=1 flat.csv || echo $?
ss-rank --load load --column mu --set stiffness=-1 flat.csv || echo $?
ss-rank --load load --column mu flat.csv coulomb || echo $?
ss-rank --normal-stress p --column mu flat.csv || echo $?
ss-rank --share --column mu flat.csv || echo $?
ss-rank --load load --column mu -o none.tsv flat.csv || [ -e none.tsv ] || echo absent
sed '1s/load (um)/load/' flat.csv > plain.csv
ss-rank --load load --column mu plain.csv || echo $?
