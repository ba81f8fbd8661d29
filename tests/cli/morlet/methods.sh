# Both methods agree, threads change nothing, and --check says so.
ss-signal noise --duration 3 > n.tsv
for method in auto quadrature fft; do
    for grid in "" "--dense --fmin 20" --dyadic; do
        # shellcheck disable=SC2086  # options are a list
        ss-morlet --method $method $grid --check n.tsv 2>&1 > one.tsv |
            sed -n 's/.* at most \([^ ]*\) of .*/\1/p' | awk '{ print ($1 < 2e-6) }'
        # shellcheck disable=SC2086
        ss-morlet --method $method $grid --threads 3 n.tsv | cmp - one.tsv
    done
done | sort | uniq -c | awk '{ print $1, $2 }'
grep '# method' one.tsv
