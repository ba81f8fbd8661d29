# Rows and notes of ss-backbone, the examples of its manual, its scenes, and what it refuses.
ss-signal ringdown --frequency 20 --damping 0.01 --duration 8 | ss-noise --snr 30 > ring.tsv
ss-backbone ring.tsv > found
head -n 1 found
sed -n 's/^# \([a-z_0-9]*\): [-0-9.e]*.*/\1/p' found
grep '^# mechanism' found
grep -v '^#' found | awk 'NF != 7 || $1 >= last && NR > 1 { print "odd:", $0 } { last = $1 }
    ($4 - 0.01) ^ 2 > 16 * $5 ^ 2 || ($2 - 20.001) ^ 2 > 16 * $3 ^ 2 { print "off:", $0 }'
ss-backbone < ring.tsv -o - | cmp - found && ss-backbone -o out.csv ring.tsv && head -n 1 out.csv
# a joint that slips, and its scene: within 5 %
ss-sim -c t,x --set base_amplitude=0 --set v0=0.3 --set settle=0 \
    --set duration=10 --set damping=1 --set friction=0.3 \
    --set contact_stiffness=500 --set contact_damping=0 \
    compliant-light | ss-noise --snr 40 > joint.tsv
ss-backbone --mass 2.42 joint.tsv | sed -n -e '/^# mechanism/p' -e 's/^# \([a-z_]*friction\|contact_stiffness\): .* \(N.*\)/\1 \2/p'
ss-backbone --mass 2.42 --fit joint.tsv > joint.scene
awk -F ' = ' '{ want["stiffness"] = 2310; want["friction"] = 0.3; want["contact_stiffness"] = 500; want["damping"] = 1 }
    $1 in want { print $1, ($2 / want[$1] > 0.95 && $2 / want[$1] < 1.05 ? "is near" : "is " $2) }' joint.scene
ss-sim -c t,x joint.scene | ss-backbone | grep '^# mechanism'
# other rigs, their scenes, within 5 %, and what these decay by
for rig in '0.8 0' '0 0.1' '0.3 0.06'; do
    set -- $rig
    ss-sim -c t,x --set mass=2.42 --set stiffness=2310 --set x0=0.01 --set "damping=$1" --set "friction=$2" free-decay \
        | ss-noise --snr 40 | ss-backbone --mass 2.42 --fit > rig.scene
    awk -F ' = ' -v "damping=$1" -v "friction=$2" '{ is[$1] = $2 }
        function far(a, b) { return a < 0.95 * b - 1e-9 || a > 1.05 * b + 1e-9 }
        END { print far(is["damping"], damping) || far(is["friction"], friction) ? "is " is["damping"] " " is["friction"] : "is near" }' rig.scene
    ss-sim -c t,x rig.scene | ss-backbone | grep '^# mechanism'
done
ss-backbone joint.tsv -o joint.gp && grep -c 'xerrorbars\|yerrorbars' joint.gp
! command -v gnuplot > /dev/null || ss-backbone joint.tsv -o joint.png || echo no picture
ss-signal noise | ss-backbone -o none.gp || echo $?
# no decay; a later one
ss-signal noise --duration 2 | ss-backbone | tail -n 2
ss-backbone --from 3 ring.tsv | grep -v '^#' | awk '$6 < 3 { print "before:", $0 }'
# samples that are missing are none, whatever stands in their place
awk '/^# columns/ { print "t,a" } !/^#/ { print $1 "," ($1 > 1.02 && $1 < 1.1 || $1 > 1.51 && $1 < 1.53 ? "" : $2) }' ring.tsv > gaps.csv
for how in split interpolate; do
    ss-backbone -q --gaps $how gaps.csv | awk '/^# mechanism/ { print }
        !/^#/ && (($4 - 0.01) ^ 2 > 16 * $5 ^ 2 || ($2 - 20.001) ^ 2 > 16 * $3 ^ 2) { print "off:", $0 }'
done
# levels
awk 'BEGIN { print "t,level"; for (i = 0; i < 2000; i++) print i / 1000 "," 90 - 17.3717793 * i / 1000 + 0.2 * sin(i * i) }' > level.csv
sed '1s/level/level (dB)/' level.csv | ss-backbone --envelope db --frequency 100 --column level | sed -n 's/^# columns: \([^ ]*\).*/\1/p'
ss-backbone --envelope db --frequency 100 level.csv | grep -v '^#' |
    awk '$3 != "-" || ($4 - 2 / 628.32) ^ 2 > 16 * $5 ^ 2 { print "off:", $0 }'
for wrong in '--periods=1' '--mode=0' '--fit' '--envelope=db' '--frequency=3' '--envelope=x'; do
    ss-backbone $wrong ring.tsv 2>> said && echo taken || echo $?
done
ss-backbone --mass 1 ring.tsv 2>> said || echo $?
ss-signal noise | ss-backbone --mass 2 --fit --unit m 2>> said || echo $?
cat said
