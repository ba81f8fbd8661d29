# By the definition, from a source that gives one sample at a time: before the next one comes, every coefficient is out
# whose window, 8.5 a behind b, ended three samples ago or earlier, and none whose has not ended.
mkfifo in
grid="--fmin 20 --fmax 40 --voices 2 --step 1 --accuracy 1e-3 --method quadrature"
ss-signal noise --rate 100 --duration 1.6 --seed 3 > s.tsv
ss-cat s.tsv -o s.au
# shellcheck disable=SC2086  # grid is a list
ss-morlet $grid s.tsv | awk '!/^#/ { print $1, $3 * 100, ($3 + 8.5 * $2) * 100 }' > windows

au_header() {   # FILE: its bytes
    od -A n -t u1 -j 4 -N 4 "$1" | awk '{ print (($1 * 256 + $2) * 256 + $3) * 256 + $4 }'
}
rows() {        # FORM: how many are out
    if [ "$1" = tsv ]; then grep -vc '^#' out || true
    else wc -c < out | awk -v head="$head_bytes" '{ print int(($1 > head) * ($1 - head) / 56) }'; fi
}
# Of the rows after sample I (the first is 0): how many there have to be, and can be, at most.
due() {
    awk -v i="$1" '$3 + 3 <= i { due++ } $3 <= i + 1e-6 { most++ } END { print due + 0, most + 0 }' \
        windows
}

follow() {      # FORM SAMPLES: samples that the tool gets by hand
    i=0
    while [ $i -lt "$2" ]; do
        if [ "$1" = tsv ]; then printf '%s\n' "$(sed -n "$((i + 1))p" cells)" >&3
        else dd if=cells bs=8 skip=$i count=1 2> /dev/null >&3; fi
        # shellcheck disable=SC2046  # two numbers
        set -- "$1" "$2" $(due $i)
        while now=$(rows "$1"); [ "$now" -lt "$3" ]; do sleep 0.02; done
        [ "$now" -le "$4" ] || { echo "$1: after sample $i already $now rows of $4"; return; }
        i=$((i + 1))
    done
    echo "$1: $2 samples, one by one; $now rows were out before the end"
}

for form in tsv au; do
    : > out
    # shellcheck disable=SC2086
    ss-morlet --stream $grid --format $form < in > out &
    tool=$!
    exec 3> in
    if [ $form = tsv ]; then
        grep '^#' s.tsv >&3
        grep -v '^#' s.tsv > cells
        head_bytes=0
    else
        start=$(au_header s.au)
        head -c "$start" s.au >&3
        tail -c +$((start + 1)) s.au > cells
        # shellcheck disable=SC2086
        ss-morlet --stream $grid --format au s.au > all.au
        head_bytes=$(au_header all.au)
    fi
    follow $form 160
    exec 3>&-
    wait $tool
done
