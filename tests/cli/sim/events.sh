# The periodic Coulomb state, to the digits that were published for it.
ss-sim --events --set settle=40 --set duration=0.4 coulomb | grep -v '^#' |
    awk '{ printf "%.12f %s %.9e %g %d\n", $1, $2, $3, $4, $5 }'
