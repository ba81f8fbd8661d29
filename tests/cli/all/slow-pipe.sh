# Rows come out as they go in, before the stream ends.
mkfifo in
: > out
ss-cat < in > out &
exec 3> in
printf '# stickslip signal 1\n# rate: 10\n# columns: t/s x\n0\t1\n' >&3
until grep -q '^0' out; do sleep 0.1; done
tail -n 1 out
printf '0.1\t2\n' >&3
exec 3>&-
wait
tail -n 1 out
