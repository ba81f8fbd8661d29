# A law is not named for what the damping of the rig does: Coulomb friction with 1.5 % of viscous damping once
# passed for a friction that falls with speed.
cat > coulomb.scene <<'S'
model = coulomb
mass = 0.25
stiffness = 40000
friction = 2.1
base_amplitude = 0.000116
base_frequency = 30
settle = 0.5
duration = 1
rate = 12000
S
sed -e 's/coulomb/stribeck/' -e 's/friction = 2.1/friction = 1.88/' coulomb.scene > falling.scene
printf 'static_friction = 2.1\nstribeck_velocity = 0.0083\n' >> falling.scene
ss-sim -c t,a -s damping=3 coulomb.scene | ss-noise --snr 40 --seed 3 > damped.tsv
ss-rank damped.tsv coulomb.scene falling.scene | sed -n 's/; .*//; s/^# answer: //p'
ss-sim -c t,a coulomb.scene | ss-noise --snr 40 --seed 3 > undamped.tsv
ss-rank undamped.tsv coulomb.scene falling.scene | sed -n 's/ [0-9.]* % .*//; s/^# answer: //p'
