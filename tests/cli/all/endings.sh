# Every ending that the help of a tool names makes a file of that form, and --format=json of each that writes rows gives
# one object a row, on standard output as in a file.
ss-sim -c t,a,x,f compliant-light --set duration=2 -o run.tsv
ss-signal ringdown --duration 4 --frequency 20 --damping .01 -o decay.tsv
awk 'BEGIN { print "# stickslip signal 1\n# rate: 40\n# columns: t x f"; for (i = 0; i < 200; i++)
    printf "%.4f\t%.9f\t%.9f\n", i / 40, sin(i * .157), (cos(i * .157) > 0 ? 1 : -1) + .01 * sin(i * i) }' > rubbed.tsv
is() {          # FORM FILE: does it begin as the form does?
    case $1 in
    tsv) grep -q "$(printf '\t')" "$2" ;;
    csv) sed 1q "$2" | grep -q '^[a-z"]' ;;
    json) ! grep -qv '^{".*}$' "$2" ;;
    gp) grep -q '^plot ' "$2" ;;
    *) head -c 5 "$2" | od -A n -c | tr -d ' ' | grep -q "^$(case $1 in
        au) echo '\.snd' ;; wav) echo RIFF ;; h5) echo '211HDF' ;; png) echo '211PNG' ;; svg) echo '<?xml' ;;
        pdf) echo '%PDF' ;; eps) echo '%!PS' ;; esac)" ;;
    esac; }
endings() {     # TOOL: those behind --output in its help
    "$1" --help | sed -nE '/--output=/,/^  -q|--format/p' | grep -oE '[.](tsv|au|csv|json|wav|h5|gp|png|svg|pdf|eps)' | cut -c 2-; }
try() {         # FORMS COMMAND: of those forms that its help names
    wanted=$1
    shift
    for form in $(endings "$1"); do
        case " $wanted " in *" $form "*) ;; *) continue ;; esac
        "$@" -q -o "out.$form" && is "$form" "out.$form" || echo "$* -o x.$form"
        [ "$form" != json ] || "$@" -q --format json | cmp - out.json
        n=$((n + 1))
    done; }
signals='tsv au csv json wav h5' pictures='gp png svg pdf eps' rows='tsv csv json' n=0
try "$signals" ss-cat run.tsv
try "$signals" ss-filter --low-pass 100 run.tsv
try "$signals" ss-sim coulomb
try "$signals" ss-signal sine
try "$signals" ss-noise --rms .1 run.tsv
try "$signals" ss-morlet --fmin 10 run.tsv
try "$signals" ss-morlet --fmin 10 --stream run.tsv
try "$rows" ss-features run.tsv
try "$rows" ss-features --stream --fmin 10 run.tsv
try "$rows" ss-features run.tsv decay.tsv
try "$rows" ss-rank run.tsv
try "$rows $pictures" ss-rank --motion x --column f rubbed.tsv
try "$rows" ss-sweep coulomb --vary mass=2:3:2
try "$rows $pictures" ss-backbone decay.tsv
try "$pictures" ss-plot run.tsv
try "$rows" ss-plot --spectrum run.tsv
try "$pictures" ss-contour -c a --fmin 10 run.tsv
echo "$n, those of ridges, and of a live signal"
for form in $rows; do
    ss-contour -c a --fmin 10 --ridge run.tsv -o "out.$form" && is "$form" "out.$form"
    ss-contour -c a --fmin 10 --ridge run.tsv --format "$form" | cmp - "out.$form"
done
for form in $pictures; do ss-contour -c a --fmin 10 --follow "live.$form" 1 run.tsv && is "$form" "live.$form"; done
ss-contour -c a --format json run.tsv || echo "exit $?"
# times are measured, so no two runs are the same
for form in $rows $pictures; do ss-trade -q -b .001 -c x rubbed.tsv -o "trade.$form" && is "$form" "trade.$form"; done
