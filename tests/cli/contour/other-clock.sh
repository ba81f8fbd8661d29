# A signal that cannot be that of the coefficients is drawn, and warned of; one that holds more is not.
ss-sim compliant-light -o run.tsv
ss-morlet --octaves=-6:-4 run.tsv -o run.h5
draw() { ss-contour --signal "$@" | grep -c '^plot'; }
draw run.tsv run.h5
ss-cat --from 1 --to 2 run.tsv -o part.tsv
ss-morlet --octaves=-6:-4 part.tsv -o part.h5
draw run.tsv part.h5
draw part.tsv run.h5
ss-cat --resample 1000 run.tsv -o slow.tsv 2> /dev/null
draw slow.tsv run.h5
draw slow.tsv -q run.h5
