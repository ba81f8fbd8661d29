# Pages of recordings: whole, the same twice, by the numbers of ss-features, and without markup of a file.
command -v gnuplot > /dev/null || { echo "no gnuplot"; exit 77; }
ss-sim --set duration=3 compliant-light > run.tsv
hostile='x<script>alert(1)<b>&"q'\''.csv'
{ printf 't_s,<img src=x onerror=alert(1)>&"\n'; awk '!/^#/ { print $1 "," $4 }' run.tsv; } > "./$hostile"
: > empty.csv
ss-report -q -j 2 -o pages run.tsv "$hostile" empty.csv none.csv 2> said && echo "status $?"
cat said
ls pages
# options before, between and behind the files
ss-report -q run.tsv "$hostile" -o again/ empty.csv -j2 -- none.csv 2> /dev/null && diff -r pages again

# what a page holds
page=pages/0001-run.tsv.html
ss-features run.tsv > found
echo "transitions $(grep -vc '^#' found), rows $(sed -n '/<h2>Transitions/,/<h2>How/p' $page | grep -c '^<tr><td>')"
sed -n 's/^# transition_frequency: //p' found | awk '{ printf "%.6f &plusmn; %.6f\n", $1, $2 }' > number
grep -c "<td>transition frequency</td><td>$(cat number)</td>" $page
grep -o '<svg' $page | wc -l
grep -c 'Triangles at the top: ' $page
grep -c "by cksum: $(cksum < run.tsv)<" $page
# the commands shown make the page's features again
sed -n '/<pre>/,/<\/pre>/p' $page | sed 's/<[^>]*>//g' > commands.sh
sed 's/ -o / -o made-/; s/--features /--features made-/; s/ run.h5$/ made-run.h5/' commands.sh | sh -eu && ls made-*
cmp made-features.tsv found

# a column that is asked for is drawn once
ss-report -q -c a -o column run.tsv && sed -n 's/.*\(ss-plot .*\)/\1/p' column/*.html

# a folder whose name is an assignment to awk
ss-report -q -o b=c run.tsv && sed 's/b=c/again/' b=c/0001-run.tsv.html | cmp - again/0001-run.tsv.html

# nothing of a file is markup: each tag is one that pages or gnuplot write, and XML has no complaint
for html in pages/*.html; do
    grep -oE '<[a-zA-Z!/?][^ >]*' "$html"
done | sort -u | grep -vxE '</?(!DOCTYPE|html|head|meta|title|style|body|p|h1|h2|a|table|thead|tbody|tfoot|tr|th|td|div|span|br|pre|svg|desc|g|rect|defs|circle|path|use|filter|feFlood|feComposite|text|tspan|polygon|image|linearGradient|stop)' || echo "no other tag"
grep -h -c -e '<img' -e '<script' pages/*.html | sort -u
grep -c 'x&lt;script&gt;alert(1)&lt;b&gt;&amp;&quot;q' pages/index.html
grep -ho 'id=["'\''][^"'\'' ]*' $page | sort | uniq -d

# whole or absent
ss-report -q -o pages run.tsv || echo "status $?"
ss-report -q -o nothing empty.csv none.csv 2> /dev/null || echo "status $?"
ss-report -q --mass=-1 -o bad run.tsv || echo "status $?"
ss-report -q -o none/pages run.tsv || echo "status $?"
[ ! -c /dev/full ] || ss-report --version > /dev/full || echo "status $?"
ss-report -o y || echo "status $?"
ss-report run.tsv || echo "status $?"
ss-report --nope || echo "status $?"
ss-report run.tsv -o || echo "status $?"
ss-report -o y - || echo "status $?"
ss-report -o y /dev/stdin < run.tsv || echo "status $?"
mkfifo pipe
ss-report -o y pipe || echo "status $?"
ls -d bad* y* nothing* none* 2> /dev/null || echo "nothing left"
