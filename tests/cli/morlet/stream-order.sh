# A stream's bytes are a function of its samples: however they are delivered, on any number of threads.
ss-signal noise --rate 200 --duration 150 --seed 5 --format au > s.au
ss-cat s.au -o s.tsv
ss-cat s.au --to 1 -o short.tsv
for form in tsv au h5; do
    for grid in '--fmin 5 --voices 1' '--fmin 20 --fmax 40 --dense --voices 3'; do
        # shellcheck disable=SC2086  # grid is a list
        {
            ss-morlet --stream $grid s.au -o whole.$form
            ss-morlet --stream $grid --threads 3 s.tsv -o part.$form
            cmp whole.$form part.$form || echo "$grid: a file of text"
            dd if=s.au bs=997 2> /dev/null | ss-morlet --stream $grid --threads 2 -o part.$form
            cmp whole.$form part.$form || echo "$grid: a pipe"
        }
    done
    for grid in '--fmin 20 --dense --voices 3' '--fmin 10 --step 0.1'; do
        # shellcheck disable=SC2086
        {
            ss-morlet --stream $grid short.tsv -o whole.$form
            for bytes in 1 977; do
                dd if=short.tsv bs=$bytes 2> /dev/null | ss-morlet --stream $grid --threads 3 -o part.$form
                cmp whole.$form part.$form || echo "$grid: a pipe, $bytes bytes at a time"
            done
        }
    done
done
