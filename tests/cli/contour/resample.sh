# A recording that is resampled is drawn as the signal that ss-cat makes of it.
ss-signal chirp --duration 4 -o whole.tsv
ss-cat whole.tsv -o whole.au
ss-cat whole.tsv -o whole.h5
ss-cat -q --resample 500 whole.tsv -o fewer.tsv
ss-contour fewer.tsv > expected
for file in whole.tsv whole.au whole.h5; do
    ss-contour -q --resample 500 "$file" | cmp - expected
done
