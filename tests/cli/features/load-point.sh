# Beside the path of a load point, ss-rank is named.
ss-sim -c t,s,z pulled-slider | sed '/^#/s/z\/m/load\/m/' > pulled.tsv
ss-features --column s pulled.tsv > numbers
grep -c '^# drop' numbers
ss-features -q --column s pulled.tsv | cmp - numbers
