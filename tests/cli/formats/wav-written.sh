# WAV that we write: 64-bit floats of the same scale, also beyond 1; from a file, a pipe and behind other bytes.
numbers() { ss-cat "$1" | awk '!/^#/' | cut -f 2-; }
awk 'BEGIN { print "t_s,x,f"; for (i = 0; i < 3000; i++) printf "%.3f,%.17g,%.17g\n", i / 1000, 2e4 * sin(i), exp(-i / 5) }' > run.csv
ss-cat run.csv -o run.wav
ss-cat run.csv --format wav > redirected.wav
cmp run.wav redirected.wav
ss-cat run.csv --format wav | cat > pipe.wav
ss-cat run.csv --format wav >> redirected.wav       # appended: both stay whole
cat run.wav pipe.wav | cmp - redirected.wav
numbers run.csv > one
for file in run pipe; do numbers $file.wav | cmp - one; done
ss-cat run.wav | head -n 4
# the header, field by field: RIFF and its length, "fmt " (code, channels, rate, bytes a second, a frame, bits), "fact", "data"
field() { od -An -v -t "$2" -j "$1" -N "$3" run.wav | tr -s ' \n' ' '; }
for place in '0 c 4' '4 u4 4' '8 c 8' '16 u4 4' '20 u2 4' '24 u4 8' '32 u2 6' '38 c 4' '42 u4 8' '50 c 4' '54 u4 4'; do field $place; echo; done
wc -c < run.wav
echo '-- what is refused leaves no file'
ss-signal sine --frequency 10 --rate 1000.5 -o no.wav || echo "exit $?"
ss-signal sine --frequency 10 --rate 1e9 --duration 1e-6 -o no.wav || echo "exit $?"
ss-morlet -c x run.csv --fmin 20 --voices 1 -o no.wav || echo "exit $?"
ss-features -c x run.csv -o no.wav || echo "exit $?"
awk 'BEGIN { for (i = 0; i < 3; i++) for (k = 0; k < 4097; k++) printf "%d%s", k, k < 4096 ? "," : "\n" }' > wide.csv
ss-cat -r 10 wide.csv -o no.wav || echo "exit $?"
[ ! -e no.wav ]
ss-sim coulomb -o no.wav -s duration=0.1 -s rate=1000 && ss-cat no.wav | grep -c '^[^#]'
