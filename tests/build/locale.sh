# A program may have chosen a locale in which numbers have a comma: what the library writes is the same to the byte.
[ -z "$SAN" ] || { echo "a library that is loaded before the checker of memory stops it"; exit 77; }
[ "$(uname)" = Linux ] || { echo "libraries are loaded before a program by LD_PRELOAD"; exit 77; }
[ -n "${LOCALES-}" ] || { echo "no localedef with de_DE, of the package locales"; exit 77; }
cat > german.c <<'C'
#include <locale.h>
#include <stdio.h>
#include <string.h>
__attribute__((constructor)) static void
speak_german(void)
{
    char number[16];
    setlocale(LC_ALL, "de_DE.UTF-8");
    snprintf(number, sizeof number, "%.1f", 0.5);
    if (strcmp(number, "0,5") != 0)
        fputs("no comma\n", stderr);
}
C
$CCLD -shared -fPIC -o german.so german.c
german() { env LD_PRELOAD="$PWD/german.so" LOCPATH="$LOCALES" "$@"; }

ss-sim --set duration=.4 --columns t,x,v,a,f compliant-light > run.tsv
ss-sim --set duration=.4 --columns t,x,v,a,f compliant-heavy > other.tsv
ss-morlet -c a -o run.h5 run.tsv
ss-features -c a run.tsv > found.tsv
ss-sweep -m amplitude,energy --vary friction=.5:1.5:5 --vary mass=1:3:4 coulomb > sweep.tsv
ss-sweep -m period,x_phase,v_phase --strobe 3 --vary base_frequency=.5:.7:4 --max-cycles 50 chaos > strobe.tsv
n=0
while read -r command; do
    sh -c "$command" > right 2> said || echo "$command: $(cat said)"
    german sh -c "$command" > text 2> said_german || echo "$command: $(cat said_german)"
    cmp right text || { echo "$command"; diff right text | sed 4q; }
    cmp said said_german || echo "$command"
    n=$((n + 1))
done << 'END'
ss-plot run.tsv
ss-plot --features found.tsv run.tsv
ss-plot --over other.tsv -c a run.tsv
ss-plot --xy x,v run.tsv
ss-plot --spectrum -c a run.tsv
ss-plot --spectrum --db -c a run.tsv
ss-plot --map friction,mass,amplitude sweep.tsv
ss-plot --map base_frequency,x_phase strobe.tsv
ss-contour --fill --ridge --features found.tsv run.h5
ss-features -c a run.tsv
ss-cat run.tsv
ss-cat --format csv --resample 1500 run.tsv
ss-rank -q run.tsv compliant-light compliant-heavy
ss-rank --fit -q -s mass=2 other.tsv coulomb || :
ss-rank -q -c a other.tsv coulomb state-variable
ss-noise --snr 20 --bits 8 --range .1 run.tsv
ss-morlet -c a --fmin 60 run.tsv
ss-sim --set duration=.5 coulomb
ss-sim -e --set duration=.5 compliant-light
ss-sweep -m amplitude --vary friction=.5:1.5:3 coulomb
ss-cat --rate 1500.5 run.tsv || :
ss-morlet -c a --fmin .001 run.tsv || :
ss-sim --set duration=1e9 --set rate=1e9 compliant-light || :
ss-features --mass -1 run.tsv || :
END
echo "$n the same"
# Times differ from run to run; no number has a comma.
german ss-trade -q -b 0.001 -o trade.gp coulomb
german ss-trade -q --models -o models.gp compliant-light
sed -n '/<< *EOD/,/^EOD/p; / = [0-9]/p' trade.gp models.gp > numbers
[ "$(wc -l < numbers)" -gt 20 ] || cat numbers
! grep -n '[0-9],[0-9]' numbers
! grep -n 'range \[[^]]*,' trade.gp models.gp
