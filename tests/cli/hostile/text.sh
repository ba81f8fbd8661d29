# Text that is not quite text: each is read as meant or refused in one line.
refused() { "$@" > /dev/null || echo $?; }

# The last line may lack its newline.
ss-sim --set settle=0 --set duration=0.05 coulomb > run.tsv
ss-morlet run.tsv > c.tsv
ss-sim --events coulomb > events.tsv
chop() { printf %s "$(cat "$1")"; }
chop run.tsv | ss-cat | cmp - run.tsv
chop c.tsv | ss-contour > a.gp
ss-contour c.tsv | cmp - a.gp
chop events.tsv | ss-contour --events - c.tsv > a.gp
ss-contour --events events.tsv c.tsv | cmp - a.gp
chop "$SRC/data/scenes/coulomb.scene" | ss-sim --set settle=0 --set duration=0.05 - > b.tsv
grep -v '^#' b.tsv > b
grep -v '^#' run.tsv | cmp - b
printf 't;x\n0;1\n0,5;2' | ss-cat | tail -n 1

# Lone CRs, as old Macs ended lines.
printf 't;x\r0;1\r0,5;2\r' | refused ss-cat
printf 't;x\n0;1\r0,5;2\n' | refused ss-cat
tr '\n' '\r' < run.tsv | refused ss-cat
tr '\n' '\r' < c.tsv | refused ss-contour
tr '\n' '\r' < "$SRC/data/scenes/coulomb.scene" | refused ss-sim -

# UTF-16 of either order, with and without a mark.
wide() {
    LC_ALL=C awk -v before="$1" -v behind="$2" '{
        gsub(/./, before "&" behind); printf "%s%s\n%s", $0, before, behind }' | tr '@' '\0'
}
{ printf '\377\376'; printf 't;x\n0;1\n1;2\n' | wide '' @; } | refused ss-cat
{ printf '\376\377'; printf 't;x\n0;1\n1;2\n' | wide @ ''; } | refused ss-cat
printf 't;x\n0;1\n1;2\n' | wide '' @ | refused ss-cat
wide '' @ < run.tsv | refused ss-cat
wide '' @ < c.tsv | refused ss-contour
wide @ '' < "$SRC/data/scenes/coulomb.scene" | refused ss-sim -

# A NUL in a row, letters that drive a terminal, no letter at all.
printf '# stickslip signal 1\n# rate: 1\n# columns: x\n1\0\n' | refused ss-cat
printf '# stickslip coefficients 1\n# k\0: v\n' | refused ss-contour
printf 't;x\n0;1\n1;\033[2J\a\n' | refused ss-cat
printf 'mo\033[2Jdel = 1\n' | refused ss-sim -
refused ss-cat "$(printf 'no\nsuch\rfile')"
printf '\n\n\n' | refused ss-cat
printf '# stickslip coefficients 1\n# start: 1e999\n' | refused ss-contour

# Control characters of 8 bits drive a terminal, too: alone, in UTF-8, and not as parts of letters.
printf 't;x\n0;1\n1;a\2332Jb\302\2332J\303\233\342\200\233\n' | refused ss-cat
refused ss-cat "$(printf -- '--\033[2J=x')"
refused ss-cat "$(printf -- '-c\303\233')" run.tsv
