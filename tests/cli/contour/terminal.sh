# A script goes to a terminal only if it is asked for there: the line tells how to see a picture.
# A session of its own: script of util-linux 2.34 ends its whole group when its input does.
script() { setsid -w script "$@"; }
script -qec true /dev/null < /dev/null > log 2>&1 || { echo "no pseudo-terminal to be had"; exit 77; }
ss-sim coulomb -o run.tsv
ss-sweep --vary friction=.5:1:3 coulomb -o map.tsv
for command in 'ss-contour -c force run.tsv' 'ss-plot run.tsv' 'ss-plot --spectrum run.tsv' 'ss-plot --map friction,period map.tsv'; do
    script -qec "$command" /dev/null < /dev/null > log && echo 'none' || echo "status $?"
    tr -d '\r' < log
done
lines() { script -qec "$1" /dev/null < /dev/null | tr -d '\r' | sed -n '1 { s/libstickslip [0-9.]* /libstickslip /; p; }'; }
lines 'ss-plot run.tsv -o -'
lines 'ss-plot run.tsv | cat'
lines 'ss-plot --spectrum --format tsv -c x run.tsv'
