# stop.sh: source it for tools that are stopped as the N-th call begins that writes or that makes,
# renames or removes a file.  The moment is the tool's own, so every machine stops it there.
[ "$(uname)" = Linux ] || { echo "calls are counted on Linux only"; exit 77; }
here=$PWD
$CCLD -o stop_at "$SRC/tests/stop/stop_at.c"
status=0
./stop_at 0 2 calls true || status=$?
[ $status != 77 ] || { echo "no program may trace another here"; exit 77; }
rm calls
: > hits
# the checker of leaks cannot work in a process that is traced
ASAN_OPTIONS=$ASAN_OPTIONS:detect_leaks=0

# How many such calls a whole run has.
calls_of() {
    "$here/stop_at" 0 2 "$here/calls" "$@" > /dev/null
    cat "$here/calls"
    rm "$here/calls"
}

# stopped N SIGNAL COMMAND ...: signals have their numbers, HUP 1, INT 2, QUIT 3, KILL 9, TERM 15.
stopped() {
    n=$1 signal=$2
    shift 2
    "$here/stop_at" "$n" "$signal" "$here/hits" "$@"
}

# How many runs were hit at work since the last time that this was asked.
hits() {
    wc -l < "$here/hits" | tr -d ' '
    : > "$here/hits"
}
