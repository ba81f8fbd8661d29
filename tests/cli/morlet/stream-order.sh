# A stream's bytes are a function of its samples: however a pipe delivers them, on any number of threads.
ss-signal noise --rate 200 --duration 6 --seed 5 > s.tsv
head -n 400 s.tsv > short.tsv
deliver() {     # FILE BYTES: that many at a time
    dd if="$1" bs="$2" 2> /dev/null
}
for grid in '--fmin 5' '--fmin 20 --dense --voices 3' '--fmin 5 --step 0.1' '--fmin 5 --method fft'; do
    for form in tsv au h5; do
        # shellcheck disable=SC2086  # grid is a list
        {
            deliver short.tsv 1000000 | ss-morlet --stream $grid -o whole.$form
            for threads in 1 2 4; do
                for bytes in 1 977; do
                    deliver short.tsv $bytes | ss-morlet --stream $grid --threads $threads -o part.$form
                    cmp whole.$form part.$form || echo "$grid, $bytes bytes, $threads threads"
                done
            done
            ss-morlet --stream $grid s.tsv -o whole.$form
            ss-morlet --stream $grid --threads 3 -o part.$form < s.tsv
            cmp whole.$form part.$form || echo "$grid, a file"
        }
    done
done
