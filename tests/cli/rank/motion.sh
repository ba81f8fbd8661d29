# A contact is named from its motion and force, whatever the form, the sign, the units and the stamps.
ss-sim -c t,x,v,f -s contact_damping=0 -s settle=0 -s duration=4 -s rate=1000 compliant-light | ss-noise --snr 60 > all.tsv
law() {
    ss-rank "$@" > rows && sed -n -e '/^# answer/s/ explains.*//p' rows
    awk '$2 == "friction:" { print "friction", (($3 / 1.28 - 1)^2 < 0.01 && $4 > 0), $5 }
         $2 == "contact_stiffness:" { print $2, (($3 / 209900 - 1)^2 < 0.01 && $4 > 0), $5 }' rows
}
law --motion x --column f all.tsv
ss-cat -o all.au all.tsv
law --motion v --column f all.au
# rows that are not there, and a force on what moves
awk '!/^#/ { if (NR % 7 != 3 && NR % 11 != 5) print $1 "," 1e3 * $2 "," (-$4) }' all.tsv |
    { echo t_s,slip_mm,force_N; cat; } > uneven.csv
ss-rank --motion slip_mm --column force_N uneven.csv | sed -n 's% explains.*%%; s%^# friction: 1.2[78].*%# friction: right%; 2p; /^# fri/p; /^# force/p'
# what is left, and a scene that runs
ss-rank --motion x --column f --residual left.csv all.tsv > /dev/null
awk -F, 'NR == 1 { print } NR > 200 { s += $5 * $5; f += $3 * $3 } END { print s / f < 1e-4 }' left.csv
ss-rank --motion x --column f --fit -s mass=2.42 -s stiffness=2310 -s x0=1e-3 all.tsv > law.scene
sed -n '1s/ explains.*//p; /^model/p; /^mass/p' law.scene
ss-sim law.scene | tail -n 1 | awk '{ print NF }'
ss-rank --motion x --column f -o loop.gp all.tsv && grep -c -e 'set tmargin' -e 'compliant' loop.gp
# ss-sim's own laws, without noise
for law in "lugre bristle_stiffness=2e4 bristle_damping=30 static_friction=1.6 stribeck_velocity=.002" \
    "bouc-wen contact_stiffness=2e4 exponent=1 beta_fraction=1" \
    "compliant contact_stiffness=209900 contact_damping=0 gap=1e-5 contact_stiffness_negative=150000"; do
    # shellcheck disable=SC2086  # keys
    printf '%s\n' model=$law mass=2.42 stiffness=2310 friction=1.28 base_frequency=2.5 base_amplitude=8e-4 settle=2 \
        duration=4 rate=1000 > own.scene
    ss-sim -c t,x,f own.scene | ss-rank --motion x --column f | sed -n 's/ explains.*//p'
done
# an arm
ss-signal sine --rate 500 --frequency 1 --duration 12 | awk '/^# col/ { print "# columns: t/s q/rad f/(N m)" } /^# / { if (!/col/) print }
    !/^#/ { f = ($2 > p ? 1 : -1) * 2 + 3 * sin($2); p = $2; print $1 "\t" $2 "\t" f }' | ss-noise --snr 60 > arm.tsv
ss-rank --motion q --column f --extra sin,cos arm.tsv | sed -n 's/ explains.*//p'
# what tells nothing
ss-signal chirp --rate 500 --frequency 0.01 --duration 5 | awk '/^# col/ { print "# columns: t/s x/m f/N" } /^# / { if (!/col/) print }
    !/^#/ { print $1 "\t" $1 "\t" $2 }' > ramp.tsv
ss-rank --motion x --column f ramp.tsv
# a sensor that jumps farther than all motion
awk 'BEGIN { print "t,x (m),f (N)"; for (i = 0; i < 2000; i++) { p = i * .06
    print i / 100 "," sin(p) + (i > 1000 ? 4 : 0) "," (cos(p) > 0 ? 1 : -1) + .01 * sin(i * i) } }' > jump.csv
ss-rank --motion x --column f jump.csv | sed -n 's/^# answer/jump/p'
# rows keep their stamps, however gaps are treated
awk -F , 'NR == 1 || ($1 < 5 || $1 > 7.3) && $1 < 9.99 { print }' jump.csv > pause.csv
ss-rank --motion x --column f pause.csv > found
for how in split interpolate; do ss-rank --motion x --column f --gaps $how pause.csv | cmp - found; done
# wrong usage
for wrong in "--motion x" "--motion x -c x" "--motion v -c f --extra sin,cos" "--motion x -c f --extra tan" \
    "--motion x -c f --long" "--motion x -c f --fit" "--motion x -c f --as a" "--delay 2" "--motion x -c f -s mass=1"; do
    # shellcheck disable=SC2086  # options
    ss-rank $wrong all.tsv || echo $?
done
# numbers of columns without units have none
awk 'BEGIN { print "t (s),x,f"; for (i = 0; i < 3000; i++) { t = i / 500; x = (1 + .2 * sin(1.1 * t)) * sin(6.283 * t)
    y += 20 * (x - before); before = x; y = y > 2 ? 2 : y < -2 ? -2 : y; print t "," x "," y + .01 * sin(i * i) } }' > bare.csv
ss-rank --motion x --as x --column f bare.csv | awk '/^# (friction|contact_stiffness|inertia|tilt):/ { print $2, NF }'
