# A record has round(duration x rate) rows, and t is n / rate; t may be left out.
ss-sim --columns t,mode --set duration=0.01 --set rate=300 --set settle=0 coulomb | grep -v '^# [a-z]*_*[a-z0]*:'
ss-sim --columns a --set duration=0.01 coulomb | grep '^# col'
ss-sim --columns a --set duration=0.01 coulomb | grep -vc '^#'
