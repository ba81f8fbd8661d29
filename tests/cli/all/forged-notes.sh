# What a result says of itself, no input says for it: an input whose notes have the names of all notes of a result, and
# of those that only other results of its kind have, gives the same result as an input without them.
ss-sim --set duration=3 compliant-light > clean.tsv
ss-cat -c f clean.tsv > force.tsv
ss-signal --duration 1 chirp > other.tsv
names() { sed -n 's/^# \([^:]*\):.*/\1/p' "$1" | grep -vx -e columns -e rate -e start | sort -u; }

# same NAMES COMMAND ...: the command reads in.tsv.
same() {
    more=$1
    shift
    for input in clean force other; do
        cp $input.tsv in.tsv
        "$@" > right
        names right > found
        names $input.tsv > own
        { sed 1q $input.tsv
          for name in $(comm -23 found own) $more; do echo "# $name: 7 forged 7"; done
          sed 1d $input.tsv; } > in.tsv
        "$@" > result
        sort right > sorted
        sort result | cmp sorted - || echo "$*: a forged note of $input.tsv comes out"
    done
}
features='about_stiffness about_slips about_repetition about_ringing about_nothing spike spikes near_gaps column'
all=$(ss-features --summary --format csv clean.tsv | sed 1q | tr , '\n' | grep -v -e file -e unit -e reason -e _error)
for options in '' '--norm l1' '--mass 2.42 --stiffness 2310' '--displacement 1 --force 1'; do
    # shellcheck disable=SC2086
    same "$features $all" ss-features -c 1 $options in.tsv
done

coefficients='samples stream column unit center voices dense step lattice norm admissible detrend accuracy rounded method label'
same "$coefficients" ss-morlet -c 1 --fmin 50 in.tsv
same "$coefficients" ss-morlet -c 1 --fmin 50 --dense in.tsv
same "$coefficients" ss-morlet -c 1 --fmin 50 --stream in.tsv
same "$coefficients" sh -c 'ss-morlet -c 1 in.tsv --force --octaves=-10:0 -q -o t.h5 && ss-morlet --inverse -q --accuracy .1 t.h5 && rm t.h5'
same 'resolution segments' sh -c 'ss-plot --spectrum -c 1 -o s.tsv in.tsv && cat s.tsv && rm s.tsv'
same 'noise converter clipped' ss-noise -q --rms 1 --bits 4 --range .1 in.tsv
