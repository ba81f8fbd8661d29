# Names of columns, units, notes and files in every shape that gnuplot or a shell has a meaning for:
# each picture is made, nothing runs, and the scripts say the same when gnuplot reads them.
# shellcheck disable=SC2016  # nothing is to be expanded, that is the point
command -v gnuplot > /dev/null || { echo "no gnuplot"; exit 77; }
mkdir work
cd work
number=0
while IFS= read -r text; do
    number=$((number + 1))
    one=$(printf %s "$text" | tr ' /' '__')
    {
        echo '# stickslip signal 1'
        printf '# scene: %s\n# model: %s\n' "$text" "$text"
        printf '# rate: 100\n# columns: t/s a%s/(%s) b\n' "$one" "$(printf %s "$text" | tr -d '()')"
        awk 'BEGIN { for (i = 0; i < 100; i++) printf "%.2f\t%.4f\t%.4f\n", i / 100, sin(i), cos(i) }'
    } > run.tsv
    ss-plot -o plot.svg run.tsv
    ss-plot --title "$text" --xy 1,2 -o xy.svg run.tsv
    ss-morlet --column 1 --voices 2 run.tsv > c.tsv
    ss-contour --title "$text" --signal run.tsv --column 1 -o contour.svg c.tsv
    file=$(printf %s "$text" | tr / _)
    ss-plot -o "$file.svg" run.tsv
    ss-plot -o "$file.gp" run.tsv
    GNUTERM=dumb gnuplot "$file.gp" > drawn 2> words || { echo "$text"; cat words; }
    for picture in plot.svg xy.svg contour.svg "./$file.svg"; do
        grep -q '</svg>' "$picture" || echo "$number: $picture"
    done
    rm -f plot.svg xy.svg contour.svg run.tsv c.tsv drawn words "./$file.svg" "./$file.gp"
    ls -A
done <<'END'
"; system "touch pwned"; "
'; system 'touch pwned'; '
`touch pwned`
$(touch pwned)
\" . system("touch pwned") . \"
'.system('touch pwned').'
''; system ''touch pwned''; ''
@pwned @title @colour
\n\t\\ \047; system "touch pwned"; \047
EOD
%s %d %n %%
{/*9 x} x_{y} x^{2} ~a{.8-} &{space}
| touch pwned
$panel1 << EOD
# comment
ä µ Ω ² 漢字
'''
"""
END
# A name with a newline in it, a folder that says something to gnuplot or sh.
newline=$(printf 'a\n; touch pwned; .svg')
ss-signal sine | ss-plot -o "$newline"
mkdir '$(touch pwned)' "'; system 'touch pwned'; '"
for folder in '$(touch pwned)' "'; system 'touch pwned'; '"; do
    ss-signal sine | ss-plot -o "$folder/a.pdf"
    ls "$folder"
done
[ ! -e pwned ] || echo pwned
