# A slow source, as text and as a table: a coefficient comes no later behind b than -v says, while the source waits; the
# end brings the rest, and all is what the whole record gives.
morlet() { ss-morlet --fmin 120 --fmax 200 --voices 2 --step 1 "$@"; }
mkfifo in
for form in tsv csv; do
    ss-signal sine --rate 1000 --frequency 150 --duration 6 | ss-cat --format $form > s
    : > out
    morlet -v --stream < in > out 2> err &
    exec 3> in
    head -n $(($(wc -l < s) - 100)) s >&3
    # 5900 samples, up to 5.899 s
    until grep -q behind err; do sleep 0.1; done
    delay=$(sed -n 's/.* to \([^ ]*\) s (of .*behind b/\1/p' err)
    expected=$(morlet s | awk -v delay="$delay" '!/^#/ && $3 + delay <= 5.899 { n++ } END { print n + 0 }')
    [ "$expected" -gt 300 ] || echo "$expected coefficients are due"
    until [ "$(grep -vc '^#' out)" -ge "$expected" ]; do sleep 0.1; done
    echo "all that is due is there"
    tail -n 100 s >&3
    exec 3>&-
    wait
    tail -n 1 out
    grep -v '^#' out | cut -f 1-4,7 | sort > a
    morlet s | grep -v '^#' | cut -f 1-4,7 | sort | cmp - a
done
