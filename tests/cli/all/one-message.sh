# Whatever is wrong with a file, or with where the output goes: one line says so.
[ -c /dev/full ] || { echo "no /dev/full"; exit 77; }
ss-sim --set duration=0.2 coulomb -o run.tsv
ss-cat run.tsv -o run.h5
ss-cat run.tsv -o run.au
ss-morlet --dyadic run.tsv -o c.tsv
head -c 3000 run.h5 > cut.h5
head -c 60 run.au > cut.au
head -n 20 c.tsv > cut.tsv
{ cat run.tsv; echo x; } > bad.tsv
printf 'model = nope\n' > bad.scene
: > empty
mkdir dir
one_line() {    # RC COMMAND...
    lines=$(grep -c '' err || true)
    [ "$1" = 1 ] && [ "$lines" = 1 ] || { echo "exit $1, $lines lines: $2"; head -n 3 err; }
}
while read -r tool; do
    for file in cut.h5 run.h5:/nope cut.au cut.tsv bad.tsv bad.scene empty dir none; do
        rc=0
        $tool $file > out 2> err < /dev/null || rc=$?
        one_line $rc "$tool $file"
    done
done <<'END'
ss-cat
ss-noise --rms 1
ss-noise --snr 3
ss-plot
ss-plot --xy x,v
ss-plot --map a,b,c
ss-morlet
ss-morlet --stream --fmin 20
ss-morlet --inverse
ss-contour
ss-contour c.tsv --signal
ss-contour c.tsv --events
ss-contour c.tsv --features
ss-features
ss-backbone
ss-rank
ss-trade
ss-sim
ss-sweep --vary mass=1:2:2
END
while read -r command; do
    rc=0
    $command > /dev/full 2> err < /dev/null || rc=$?
    one_line $rc "$command"
done <<'END'
ss-signal sine
ss-cat run.tsv
ss-cat run.h5 --format au
ss-noise --rms 1 run.tsv
ss-plot run.tsv
ss-morlet --dyadic run.tsv
ss-morlet --stream --fmin 20 run.tsv
ss-contour c.tsv
ss-sim coulomb
ss-sim --list
ss-cat --help
ss-cat none
END
