# Each fault of a scene is one line with file and line, exit 1, and nothing on standard output.
try() {
    printf "$1" > bad.scene
    status=0
    ss-sim -o out.tsv bad.scene || status=$?
    echo "exit $status: $(ls)"
}
good='mass=2\nstiffness=50\nfriction=1\nbase_amplitude=.1\nbase_frequency=1\n'
try "model=coulomb\n${good}mas = 3\n"
try "model=coulomb\n${good}mass = 3\n"
try "model=coulomb\nmass=2\n"
try "model=coulomb\n${good}alpha = 3\n"
try "model=coulomb\nmass = -2\n"
try "model=coulomb\nmass = heavy\n"
try 'hello\n'
try ''
