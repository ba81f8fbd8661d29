# Every example of the manual, and every command of the README's, as it is printed there: it runs
# and says nothing on standard error.  What they give is for the other tests of examples to see.
for p in gnuplot awk; do command -v $p > /dev/null || { echo "no $p"; exit 77; }; done
GNUTERM=dumb
export GNUTERM
mkdir bin
# As much of GNU parallel as the examples need: -j, {} and {/}, jobs behind ::: or on standard input.
command -v parallel > /dev/null || cat > bin/parallel << 'EOF'
#!/bin/sh
[ "$1" != -j ] || shift 2
all=$*
command=${all%% :::*}
case $all in *' ::: '*) printf '%s\n' ${all##*::: } ;; *) cat ;; esac | while read -r job; do
    eval "$(echo "$command" | sed "s|{}|$job|g; s|{/}|${job##*/}|g")" < /dev/null || exit
done
EOF
python3 -c 'import numpy' 2> /dev/null || printf '#!/bin/sh\n' > bin/python3
command -v Rscript > /dev/null || printf '#!/bin/sh\n' > bin/Rscript
command -v ffmpeg > /dev/null || printf '#!/bin/sh\n[ -s frame0.png ] && [ -s frame4.png ] && : > run.mp4\n' > bin/ffmpeg
command -v h5dump > /dev/null || printf '#!/bin/sh\n' > bin/h5dump
# shellcheck disable=SC2016  # for the script written
command -v sox > /dev/null ||
    printf '#!/bin/sh\n[ "$4" != - ] || exec ss-signal sine --rate 44100 --format au\ncat > /dev/null\n' > bin/sox
# ss-trade measures as long as it is let.
printf '#!/bin/sh\nexec "%s/bin/ss-trade" "$@" --budget 0.05\n' "$BUILD" > bin/ss-trade
chmod +x bin/*
PATH=$PWD/bin:$PATH

# The recordings that they name.
ss-sim --columns t,x,a,f compliant-light --set duration=6 --set settle=0 --set rate=4000 |
    awk 'BEGIN { print "t,x,a,f,force" } !/^#/ { gsub("\t", ","); print $0 "," $0 }' |
    awk -F, '{ print $1 "," $2 "," $3 "," $4 "," (NR == 1 ? $5 : $4) }' > recording
awk 'BEGIN { print "t,x"; for (i = 0; i < 500; i++) if (i < 100 || i > 160)
    print (i + 0.3 * sin(i)) / 1000 "," i }' > log.csv
# A second of sound, 8 bits at 44.1 kHz: 44 bytes of header and 44100 samples.
{
    printf 'RIFF\150\254\000\000WAVEfmt \020\000\000\000\001\000\001\000'
    printf '\104\254\000\000\104\254\000\000\001\000\010\000data\104\254\000\000'
    awk 'BEGIN { for (i = 0; i < 44100; i++) printf "%c", 80 + int(40 * sin(i * (0.01 + i / 1e6))) }'
} > run.wav
cp run.wav bass.wav

try() {         # NAME: the commands on standard input, in a directory of their own
    mkdir "$1"
    cat > "$1.sh"
    cp recording "$1/run.csv"
    ss-cat recording -o "$1/run.tsv"
    ! grep -q 'no-clock\.csv' "$1.sh" || cut -d , -f 2- recording > "$1/no-clock.csv"
    cp run.wav bass.wav "$1"
    ! grep -q 'tests/conformance' "$1.sh" || ln -s "$SRC/tests" "$1/tests"
    ! grep -q 'log\.csv' "$1.sh" || cp log.csv "$1"   # it has a gap, and *.csv would be it, too
    [ -s "$1.sh" ] || echo "$1: no examples"
    (cd "$1" && sh -eu "../$1.sh" > ../out 2> ../err < /dev/null) || echo "$1: exit status $?"
    # sox says that a pipe has no length, gnuplot that the C locale has no degree sign, ss-sim -v what
    # it does.
    grep -v -i -e '^sox WARN' -e 'iconv failed' -e '^ss-sim: .* tol 1e-09' \
        -e '^ss-sim: .* of CPU' err | sed "s/^/$1: /"
}

for page in "$SRC"/man/*.[157]; do
    awk '/^\.Sh/ { here = /EXAMPLES|FROM A RECORDING/ } /^In Python:/ { here = 0 } !here { next }
        /^\.Dl/ { sub(/^\.Dl /, ""); print }
        /^\.Bd/ { block = 1; next } /^\.Ed/ { block = 0 } block { print }' "$page" |
        sed 's/\\e/\\/g' > text
    case $page in
    *-scene.5) ss-sim - < text > record && [ -s record ] ;;
    *)         grep -v '^# ' text | try "$(basename "$page")" ;;
    esac
done
grep -E '^    (ss-|sox)' "$SRC/README.md" | try README

# The C of stickslip(3).
{
    printf '#include <stickslip.h>\nint main(void) {\n'
    awk '/^\.Sh/ { here = /EXAMPLES/ } here && /^\.Bd/ { block = 1; next } /^\.Ed/ { block = 0 }
        block { print }' "$SRC/man/stickslip.3" | sed 's/\\e/\\/g'
    printf 'ss_signal_free(signal); return 0; }\n'
} > page.c
# shellcheck disable=SC2086  # flags are lists
$CCLD -Wall -Werror -I"$SRC/include" -o page page.c "$BUILD/libstickslip.a" $LIBS
./page
