# The examples of ss-sim(1) and stickslip-scene(5).
command -v gnuplot > /dev/null || { echo "no gnuplot"; exit 77; }
ss-sim --columns t,x compliant-light > x.tsv
grep -vc '^#' x.tsv
ss-sim --events --set duration=0.5 compliant-light | grep -w slip | cut -f 2
ss-sim compliant-heavy | ss-plot --xy x,f -o loop.png
[ -s loop.png ]
ss-sim --list --set mass=1.8 compliant-heavy -o mine.scene
grep -e '^#' -e mass mine.scene
ss-sim mine.scene | ss-plot -o mine.png
[ -s mine.png ]
ss-sim mine.scene | grep -v '^# scene:' > mine.tsv
ss-sim --set mass=1.8 compliant-heavy | grep -v '^# scene:' | cmp - mine.tsv
sed -n '/^# a stiffer contact/,/^\.Ed/p' "$SRC/man/stickslip-scene.5" | grep -v '^\.Ed' > stiffer.scene
ss-sim stiffer.scene | grep -vc '^#'
