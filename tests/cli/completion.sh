# Completion in bash: options, scenes, columns from a file's header, methods.
command -v bash > /dev/null || { echo "no bash"; exit 77; }
ss-sim compliant-light --set duration=0.01 --set settle=0 -o run.tsv
bash -eu > out <<'BASH'
compopt() { :; }
. "$SRC/data/completion/stickslip.bash"
try() {
    COMP_WORDS=("$@")
    COMP_CWORD=$(($# - 1))
    _stickslip "$1" "${COMP_WORDS[COMP_CWORD]}" "${COMP_WORDS[COMP_CWORD - 1]}"
    echo "$*: ${COMPREPLY[*]-}"
}
try ss-sim --ev
try ss-sim --max
try ss-morlet --det
try ss-sim comp
try ss-sim --method rk8
try ss-sim -m ex
try ss-plot run.tsv --column ''
try ss-plot run.tsv --column = a
try ss-cat ru
try ss-plot --xy ''
try ss-noise none.tsv -c ''
BASH
cat out
# Every tool and none else.
for tool in "$SRC"/tools/ss-*.c; do
    name=$(basename "$tool" .c)
    for file in "$SRC"/data/completion/*; do grep -qw -e "$name" "$file" || echo "$name is not in $file"; done
done
command -v zsh > /dev/null || exit 0
zsh -n "$SRC/data/completion/_stickslip"
