# Rows come out as they go in, before the stream ends.
mkfifo in
ss-cat < in > out &
exec 3> in
printf '# stickslip signal 1\n# rate: 10\n# columns: t/s x\n0\t1\n' >&3
for _ in 1 2 3 4 5 6 7 8 9 10; do
    grep -q '^0' out && break
    sleep 0.3
done
tail -n 1 out
printf '0.1\t2\n' >&3
exec 3>&-
wait
tail -n 1 out
