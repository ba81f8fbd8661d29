# What is no decay, or hardly one, gives an answer or one clear line, and nothing half-written.
try() {         # FILE ARGUMENTS...
    name=$1; shift
    status=0
    ss-backbone "$@" "$name.csv" > out 2> err || status=$?
    echo "$name: exit $status, $(grep -c '^[^#a-z]' out || true) rows, $(wc -l < err) lines: $(sed 's/^.*csv: //; s/^ss-backbone: //' err | head -n 1)"
}
make() { awk "BEGIN { print \"t,x\"; for (i = 0; i < $2; i++) print i / 100 \",\" ($3) }" > "$1.csv"; }
make constant 500 7
make one 1 1
make two 2 i
make zeros 500 0
make step 500 'i > 250 ? 1 : 0'
make spike 500 'i == 250 ? 1 : 0'
make alternating 500 'i % 2 ? 1 : -1'
make growing 500 'exp(i / 100) * cos(i)'
make square 2000 'cos(i / 3) > 0 ? exp(-i / 200) : -exp(-i / 200)'
make small '2000' '1e-300 * exp(-i / 200) * cos(i / 3)'
make huge '2000' '1e300 * exp(-i / 200) * cos(i / 3)'
make clipped 2000 'exp(-i / 200) * cos(i / 3) > 0.01 ? 0.01 : exp(-i / 200) * cos(i / 3) < -0.01 ? -0.01 : exp(-i / 200) * cos(i / 3)'
for name in constant one two zeros step spike alternating growing square small huge clipped; do
    try $name -c x
done
sed '300s/,.*/,nan/' small.csv > hole.csv; try hole -c x
sed '300s/,.*/,inf/' small.csv > infinite.csv; try infinite -c x
try square -c x --mode 1e9
try square -c x --periods 1e6
try square -c x --envelope db --frequency 1e-9
try constant -c x --fit --mass 1 --unit m -o none.scene
[ ! -e none.scene ] || echo half-written
ss-backbone -c x -o square.csv square.csv 2>&1 || echo $?
