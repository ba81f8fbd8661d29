# A free decay has its mechanism, its picture and its rows, those of ss-backbone; what is none says why.
command -v gnuplot > /dev/null || { echo "no gnuplot"; exit 77; }
ss-sim free-decay > decay.tsv
ss-signal noise -d 4 > noise.tsv
ss-report -q --decay --mass 2 --column x -o pages decay.tsv
ss-report -q --decay -o noise noise.tsv
section() { sed -n '/<h2>Free decay/,/<h2>How/p' "$1"; }
ss-backbone --mass 2 -c x decay.tsv > found
section pages/0001-decay.tsv.html > html
grep -c '<svg' html
echo "rows $(grep -vc '^#' found), shown $(grep -c '^<tr><td>' html)"
sed -n '/^# mechanism/,/^# columns/s/^# \([a-z_0-9]*\): .*/\1/p' found | grep -v columns > notes
sed -n 's/^<p>\([a-z_0-9]*\): .*/\1/p' html | diff notes - && cat notes
section noise/0001-noise.tsv.html | grep '^<p>'
# the index has the answers, with as many digits as the errors allow
ss-cat -c x decay.tsv > x.tsv
ss-report -q --decay -o all x.tsv noise.tsv
sed -n '/<h2>Free decays/,/<.tbody>/p' all/index.html | sed 's/<[^>]*>/ /g; s/[0-9][0-9.]* &plusmn; [0-9.]*/V \&plusmn; E/g'
