# run.sh counts what passed, failed and was skipped, and fails if anything did.
mkdir -p tree/tests/cli tree/build/tests tree/build/bin
cp "$SRC/tests/run.sh" tree/tests
cd tree/tests/cli
echo 'echo hello'                 > good.sh;    echo hello > good.out
echo 'echo bad >&2; exit 3'       > refused.sh; echo bad > refused.err; echo 3 > refused.exit
echo 'echo no tool; exit 77'      > skipped.sh
echo 'echo more than nothing'     > more.sh
echo 'exit 1'                     > exits.sh
echo 'echo for ever'              > hangs.sh
echo 'ls -A; touch left'          > empty.sh
echo 'pwd'                        > path.sh
cd ../../build/tests
program() { printf '#!/bin/sh\n%s\n' "$2" > "$1"; chmod +x "$1"; }
program test_good    'printf "1..3\nok 1 - a\nok 2 - b\nnot ok 3 # SKIP c\n"'
program test_bad     'printf "1..2\nok 1 - a\nnot ok 2 - b\n"; exit 1'
program test_crashes 'printf "1..2\nok 1 - a\n"; kill -9 $$'
program test_leaks   'printf "1..1\nok 1 - a\n"; exit 1'
cd ../..
# a limit of time that has passed for what hangs, and for nothing else
mkdir bin
cat > bin/timeout <<'END'
#!/bin/sh
case "$*" in "-k 10 7 "*hangs.sh) exit 124 ;; esac
shift 3
exec "$@"
END
chmod +x bin/timeout
run() {
    PATH=$PWD/bin:$PATH BUILD=build CC='' CCLD='' LIBS='' SAN='' LONG='' ONLY='' TMPDIR='' LIMIT=7 sh tests/run.sh "$@" > log 2>&1 || echo "exit $?"
    sed -n -e 's/ [0-9]* s$//' -e '/^ok  /p' -e '/^FAIL/p' -e '/^skip/p' log | sort
    tail -n 2 log | grep -e "^Not tested" -e passed
}
run test_good test_bad test_crashes test_leaks
rm tests/cli/[ehmp]*.sh
run test_good
