# 0 dB at a level of its own: a signal twice as large is 6 dB louder, and drawn so.
ss-sim compliant-light | ss-cat --column a -o one.tsv
ss-cat --scale 2 one.tsv -o two.tsv
head_of() { ss-contour "$@" | sed -n -e 's/ *#.*//' -e '/^\(span\|level\|noise\|reference\) = /p'; }
head_of one.tsv
head_of two.tsv
head_of --level -20 --span 60 two.tsv
lines() { ss-contour -q "$@" | sed -n '/^\$contour/,/^EOD/p'; }
lines --level -29 one.tsv > a
lines --level -22.979400086720376 two.tsv > b
lines --level -29 two.tsv > c
cmp a b
! cmp -s a c
ss-contour --level x one.tsv || echo $?
# A palette that is reversed has a dark ground under its colours, and the same colours.
for name in viridis viridis_r; do
    ss-contour --fill --palette $name one.tsv | sed -n -e '/^colours/p' -e '/^ground/p' -e '/rectangle.*ground_colour fs/p'
done
ss-contour --palette grey_r one.tsv | grep -c ground || true
# the area within each line has its colour
ss-contour --fill one.tsv | awk -F"'" '/^drawn/ { split($2, line, " ") } match($0, /palette cb -[0-9]+[.]5/) { on[substr($0, RSTART + 11, RLENGTH - 11)] = 1 }
    END { for (i in line) { n++; filled += ("-" (line[i] - 1) ".5") in on }; print (n > 5), n - filled }'
