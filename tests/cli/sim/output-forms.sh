# The same numbers come out of every form, and a closed pipe ends the tool silently.
ss-sim -o a.tsv compliant-light
ss-sim -o a.au compliant-light
ss-sim -o a.h5 compliant-light
ss-sim - < "$SRC/data/scenes/compliant-light.scene" | grep -v '^# scene' > b.tsv
grep -v '^#' a.tsv > numbers
for f in a.au a.h5 b.tsv; do ss-cat "$f" | grep -v '^#' | cmp - numbers; done
ss-sim --format au compliant-light | cmp - a.au
ss-sim --set duration=1000 coulomb | head -n 1
ls
