# As tests/cli/all/whole-when-stopped.sh, a hundred times each: half 1 of the files.
TRIES=100 HALF=1
. "$SRC/tests/cli/all/whole-when-stopped.sh"
