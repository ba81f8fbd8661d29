# A slow source, as text and as a table: by the definition, a coefficient comes as soon as its window is complete, 8.5 a behind
# b, while the source waits; the end brings the rest, and all is what the whole record gives.
morlet() { ss-morlet --fmin 20 --fmax 40 --voices 2 --step 1 --accuracy 1e-3 --method quadrature "$@"; }
mkfifo in
for form in tsv csv; do
    ss-signal sine --rate 100 --frequency 25 --duration 3 | ss-cat --format $form > s
    : > out
    morlet --stream < in > out &
    exec 3> in
    head -n $(($(wc -l < s) - 100)) s | while read -r line; do printf '%s\n' "$line" >&3; done
    # 200 samples, up to 1.99 s: b + 8.5 a <= 1.98 s, a sample earlier for rounding
    expected=$(morlet s | awk '!/^#/ && $3 + 8.5 * $2 <= 1.98 { n++ } END { print n + 0 }')
    until [ "$(grep -vc '^#' out)" -ge "$expected" ]; do sleep 0.1; done
    echo "all that is complete is there"
    awk '!/^#/ && $3 + 8.4 * $2 > 2 { print "too early: " $0 }' out
    tail -n 100 s >&3
    exec 3>&-
    wait
    tail -n 1 out
    grep -v '^#' out | cut -f 1-4,7 | sort > a
    morlet s | grep -v '^#' | cut -f 1-4,7 | sort | cmp - a
done
