# As tests/cli/whole-when-stopped.sh, a hundred times each.
TRIES=100
. "$SRC/tests/cli/whole-when-stopped.sh"
