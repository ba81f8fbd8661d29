# A stream's rows are the record's, whatever the forms; what ends badly keeps what was complete.
ss-signal chirp --duration 4 --to 200 -o s.tsv
ss-cat s.tsv -o s.au
ss-cat s.tsv -o s.h5
grid="--fmin 10 --fmax 200 --voices 4"
rows() { grep -v '^#' "$1" | sort; }
# shellcheck disable=SC2086  # grid is a list
{
    ss-morlet $grid s.tsv -o whole.tsv
    rows whole.tsv | cut -f 1-4,7 > grid
    for input in s.tsv s.au s.h5; do
        ss-morlet --stream $grid $input -o $input.tsv
        rows $input.tsv | cut -f 1-4,7 | cmp - grid
    done
    cmp s.tsv.tsv s.au.tsv
    ss-morlet --stream $grid s.tsv > plain.tsv
    ss-morlet --stream --octaves=-6:-4 --dense --format au < s.au > dense.au
    ss-morlet --stream $grid s.tsv -o s.tsv.au
    ss-morlet $grid s.tsv -o whole.au
}
cmp plain.tsv s.tsv.tsv
# Contours are those of the whole record, also from AU; every cell is near it.
ss-contour --title x whole.tsv > whole.gp
for form in s.tsv.tsv s.tsv.au whole.au; do ss-contour --title x $form > form.gp; cmp form.gp whole.gp; done
ss-contour dense.au > dense.gp
rows whole.tsv > a
rows s.tsv.tsv | paste a - | awk '{ d = ($5 - $12) ^ 2 + ($6 - $13) ^ 2; w = $5 ^ 2 + $6 ^ 2
    if (w > top[$1]) top[$1] = w; if (d > off[$1]) off[$1] = d }
    END { for (m in top) if (off[m] > 4e-12 * top[m]) print m, off[m] / top[m] }'
echo "--- a cell that is no number, an empty input, a cut stream"
{ head -n 3000 s.tsv; printf '1.4975\tnan\n'; } > bad.tsv
ss-morlet --stream --fmin 40 bad.tsv > bad.out || echo "exit $?"
tail -n 1 bad.out | awk '{ print NF, ($3 + 8.5 * $2 < 1.4975), ($3 + 9 * $2 > 1.4) }'
ss-morlet --stream --fmin 40 bad.tsv -o bad.au || ls bad.au 2> /dev/null || echo "no bad.au"
head -n 4 s.tsv | ss-morlet --stream --fmin 40 > /dev/null || echo "exit $?"
ss-contour bad.out || echo "exit $?"
