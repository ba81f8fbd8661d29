# With standard error closed no message stands in the output; with standard output closed a file of -o
# is whole and the run a success, but what should have gone there is an error; and a closed standard
# input is not a file that was opened meanwhile.
ss-sim --set settle=2 --set duration=1 compliant-light > signal.tsv
ss-sweep -m amplitude --vary mass=2:3:4 --vary friction=1:2:4 coulomb > sweep
ss-morlet --dyadic signal.tsv > coefficients

# same FILE COMMAND ...: FILE of -o is the same with all of them closed, and exit 0
same() {
    file=$1
    shift
    "$@" -v -o "$file" 2> /dev/null || echo "$*: exit $?"
    cp "$file" whole
    for closed in 0 1 2 01 02 12 012; do
        rm "$file"
        status=0
        case $closed in
        0)   "$@" -v -o "$file" <&- 2> /dev/null ;;
        1)   "$@" -v -o "$file" >&- 2> /dev/null ;;
        2)   "$@" -v -o "$file" 2>&- ;;
        01)  "$@" -v -o "$file" <&- >&- 2> /dev/null ;;
        02)  "$@" -v -o "$file" <&- 2>&- ;;
        12)  "$@" -v -o "$file" >&- 2>&- ;;
        012) "$@" -v -o "$file" <&- >&- 2>&- ;;
        esac || status=$?
        [ $status = 0 ] || echo "$*, $closed closed: exit $status"
        cmp "$file" whole || echo "$*, $closed closed: another file"
    done
}
for end in tsv au h5; do
    same out.$end ss-cat signal.tsv
    same out.$end ss-noise --snr 1 signal.tsv
    same out.$end ss-signal sine
    same out.$end ss-sim --set duration=0.1 compliant-light
    same out.$end ss-morlet --dyadic signal.tsv
done
same out.tsv ss-features signal.tsv
same out.tsv ss-sweep -m amplitude --vary mass=2:3:2 coulomb
same out.gp ss-plot signal.tsv
same out.gp ss-contour coefficients
same out.gp ss-plot --map mass,friction,amplitude sweep
if command -v gnuplot > /dev/null; then same out.svg ss-plot signal.tsv; fi

echo "--- nowhere to write to, nothing to read"
for command in 'ss-cat signal.tsv' 'ss-signal sine' 'ss-sim coulomb' 'ss-sim --list' 'ss-morlet signal.tsv' \
        'ss-plot signal.tsv' 'ss-contour coefficients' 'ss-features signal.tsv' 'ss-cat --help' \
        'ss-rank --version' 'ss-sweep --vary mass=2:3:2 coulomb'; do
    $command >&- 2> words || echo "$? $(cat words)"
    $command >&- 2>&- && echo "$command: exit 0"
done
ss-cat <&- 2> words || echo "$? $(cat words)"
ss-sim - <&- 2> words || echo "$? $(cat words)"
