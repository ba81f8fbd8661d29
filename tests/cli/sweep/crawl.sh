# A motion that crawls to its period, by 1.7e-5 of the distance a cycle, has it: what simulation finds after a million
# cycles, shooting from its last state says at once.  A motion that has none, or more cycles than are looked for, is as it was.
rows() { ss-sweep -q -m period,stick,x_phase "$@" | sed '/^#/d'; }
set -- coulomb -s base_frequency=2.201005025125628 --vary friction=.341:.344:4
rows "$@" > quick
rows --simulate --max-cycles 1000000 --tol 1e-12 "$@" > whole
cut -f 1-3 quick
# within 2 tol of the unit, Z_e = .6 mm
paste quick whole | awk '{ if ($3 != $9 || ($4 - $10) ^ 2 > 1e-16 || ($5 - $11) ^ 2 > 1.44e-24) print "differs:", $0 }'
rows --simulate "$@" | grep -c aperiodic
rows --vary base_frequency=.6:.61:3 --max-cycles 1000 chaos | cut -f 3
