# As tests/cli/all/whole-when-stopped.sh, a hundred times each: half 2 of the files.
TRIES=100 HALF=2
. "$SRC/tests/cli/all/whole-when-stopped.sh"
