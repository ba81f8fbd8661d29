# 10,000 characters in every place that takes a name, a path, a value or text: no crash, no hang, at most one
# line of message.
ten() { awk -v piece="$1" 'BEGIN { while (length(all) < 10000) all = all piece; print substr(all, 1, 10000) }'; }
x=$(ten x) nines=$(ten 9) list=$(ten 'x,') pairs=$(ten 'a:') key=$(ten 'k=') slashes=$(ten '../')

# Ends as a tool may, and says at most one line.
check() {
    what=$1 status=0
    shift
    { "$@" 2> words < run.tsv || echo $? > status; } | head -c 1000000 > out
    [ ! -e status ] || { read -r status < status; rm status; }
    case $status in 0 | 1 | 2) : ;; *) echo "$what: exit status $status" ;; esac
    [ "$(wc -l < words)" -le 1 ] || echo "$what: $(wc words)"
}

ss-sim --set settle=0 --set duration=0.1 coulomb > run.tsv
ss-morlet run.tsv > c.tsv
turn=0
for tool in cat contour features morlet noise plot rank signal sim sweep trade; do
    case $tool in contour) input=c.tsv ;; sim | sweep) input=coulomb ;; signal) input=sine ;; *) input=run.tsv ;; esac
    for option in $(ss-$tool --help | sed -n 's/^ .*\(--[a-z-]*\)=.*/\1/p' | sort -u); do
        # a third of the values for each option, another third for the next: every kind meets every tool
        turn=$(((turn + 1) % 3))
        case $turn in
        0) set -- "$x" "$pairs" "/$x" "mass=1:$x" ;;
        1) set -- "$nines" "$key" "x=$nines" "$x.tsv" ;;
        *) set -- "$list" "$slashes" "0:$nines" "$x" ;;
        esac
        for value; do check "ss-$tool $option $(printf %.8s "$value")" ss-$tool "$option" "$value" $input; done
    done
    for value in "$x" "$nines" "./$x/$x" "run.tsv:/$x" "-$x" "--$x" "--title=$x"; do
        check "ss-$tool $(printf %.8s "$value")" ss-$tool "$value"
    done
done

# In files: names, units, notes, words of columns, keys and values.
rows() { awk -v s="$1" 'BEGIN { for (i = 0; i < 100; i++) print i s i % 7 (s == "," ? ",1" : "") }'; }
{ printf 't_s,%s,b (%s)\n' "$x" "$x"; rows ,; } > long.csv
{ printf '# stickslip signal 1\n# rate: 1\n# %s: %s\n# columns: t/s %s/%s\n' "$x" "$x" "$x" "$x"; rows '	'; } > long.tsv
printf '%s = 1\n' "$x" > key.scene
printf 'model = %s\n' "$x" > model.scene
printf 'model = coulomb\nmass = %s\n' "$nines" > value.scene
printf '# stickslip sweep 1\n# scene: %s\n# columns: index %s y/%s z status\n' "$x" "$x" "$x" > long.sweep
awk 'BEGIN { for (i = 0; i < 16; i++) printf "%d\t%d\t%d\t%d\tok\n", i, i % 4, i / 4, i * i }' >> long.sweep
printf '# stickslip features 1\n%s\n' "$x" > long.features
printf '# stickslip features 1\n# spike: 1 %s\n' "$x" > long.spike
printf '# stickslip events 1\n%s\n' "$nines" > long.events
check 'cat of a table to AU' ss-cat --format au long.csv
check 'cat of a table to HDF5' ss-cat -o long.h5 long.csv
check 'cat of HDF5' ss-cat long.h5
for file in long.csv long.tsv long.h5; do
    for tool in cat plot 'plot --xy 1,1' features 'morlet --force' 'noise --rms 1'; do
        # shellcheck disable=SC2086  # a tool and its options
        check "ss-$tool $file" ss-$tool $file
    done
    check "ss-cat --column of $file" ss-cat --column "${x}y" $file
    ss-morlet --force -o coefficients.h5 --column 1 $file
    check "contours of $file" ss-contour --signal $file coefficients.h5
done
check ss-rank ss-rank long.tsv
check ss-trade ss-trade long.tsv
for scene in key model value; do check "ss-sim $scene" ss-sim $scene.scene; check "ss-sweep $scene" ss-sweep $scene.scene; done
for names in "$x,y,z" "$x,y,$x" "y,$x,z"; do check 'a map' ss-plot --map "$names" long.sweep; done
for list in features spike; do check "$list" ss-contour --features long.$list c.tsv; done
check events ss-contour --events long.events c.tsv
