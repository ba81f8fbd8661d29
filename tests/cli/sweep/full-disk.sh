# A failed write is exit 1 and one line; a closed pipe is none of our business.
[ -w /dev/full ] || { echo "no /dev/full"; exit 77; }
set -- --vary friction=0.6:1.2:3000 coulomb
ss-sweep "$@" > /dev/full || echo $?
ss-sweep --help > /dev/full || echo $?
ss-sweep "$@" | head -n 1
