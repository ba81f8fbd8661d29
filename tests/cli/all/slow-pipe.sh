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

# Delimited text, too, with a rate or with times on a clock: each row is there before the next one is sent.
echo "-- delimited"
rows() { seq "$1" "$2" | awk '{ printf "%.3f,%d\n", $1 / 1000, $1 % 7 }'; }
there() { until [ "$(grep -c '^[^#]' out)" = "$1" ]; do sleep 0.1; done; }
comes() {                               # ROWS OPTIONS: so many rows come before the others are sent, then one by one
    first=$1
    shift
    : > out
    ss-cat "$@" < in > out &
    exec 3> in
    { echo t,x; rows 1 "$first"; } >&3
    there "$first"
    for row in $((first + 1)) $((first + 2)); do
        rows "$row" "$row" >&3
        there "$row"
    done
    rows $((first + 3)) 300 >&3
    exec 3>&-
    wait
    { echo t,x; rows 1 300; } > run.csv
    ss-cat "$@" run.csv | cmp - out && echo same
}
comes 2 --rate 1000
comes 16
comes 40 --column x
echo "-- and what is wrong with them"
refused() { "$@" > out || echo "exit $?"; }
{ echo t,x; rows 1 300 | sed 250d; } | refused ss-cat
{ echo t,x; rows 1 300; } | awk -F, -v OFS=, 'NR == 200 { $1 -= .0002 } 1' | refused ss-cat
{ echo t,x; rows 1 300; echo u,y; rows 1 30; } | refused ss-cat --rate 10
{ echo t,x; rows 1 300; echo 0.301,-; } | refused ss-cat
{ echo t,x; rows 1 300 | sed 250d; } | ss-cat --gaps=split | sed -n '254,256p'
{ echo t,x; rows 1 300; } | awk -F, -v OFS=, 'NR > 100 { $1 = $1 * 1.0001 } 1' | ss-cat --resample 1000 | tail -n 1
