#!/bin/sh
# maps.sh: maps of periodic states into $OUT, and how well the first keeps to Den Hartog's limit.
#
# den-hartog: stops a cycle and amplitude of the forced Coulomb oscillator over r = Omega / omega_n and
# beta = f_k / (k Z_e), with the limit of motion without stops (Den Hartog 1931) over it.
# microslips: micro-slips a half-cycle of the paper's compliant scene, and its transition frequency,
# over friction and the damping of the contact.
#
# symmetry: where the shipped scene shaw, with static above kinetic friction, moves farther to one side than
# to the other, by max|x| less the amplitude; from r = 1/2 on, where subharmonic has its line of motions.
#
# chaos: points of the stroboscopic map and the Lyapunov exponent of the shipped scene chaos over r.
#
# coulomb: the rms error of a if Coulomb friction takes the place of compliant-light's contact, over stiffness
# and damping of the contact.
set -eu
: "${OUT:=build/maps}" "${THREADS:=$(getconf _NPROCESSORS_ONLN)}"
mkdir -p "$OUT"

# With omega_n = 2 pi /s, k = 1 N/m and Z_e = 1 m, the base's frequency is r and friction is beta.
ss-sweep --threads "$THREADS" --shoot --max-cycles 2000 --measure stops,amplitude,period \
    --vary base_frequency=0.1025:1.8025:341 --vary friction=0.005:1.195:120 \
    -o "$OUT/den-hartog.tsv" - <<'SCENE'
model          = coulomb
mass           = 0.025330295910584444    # 1 / (2 pi)^2
stiffness      = 1
base_amplitude = 1
base_frequency = 1
friction       = 0.5
SCENE

# r and the limit of beta, by the definitions: S is the largest of a function of tau.
awk 'BEGIN {
    pi = atan2(0, -1)
    for (i = 0; i <= 680; i++) {
        r = 0.1025 + i * 0.0025
        if (i == 359)
            continue                    # r = 1: V has no value
        U = sin(pi / r) / (r * (1 + cos(pi / r)))
        V = 1 / (1 - r * r)
        S = 1
        for (tau = 0.002; tau < pi; tau += 0.002) {
            s = (r * sin(tau / r) + U * r * r * (cos(tau) - cos(tau / r))) / sin(tau)
            S = s > S ? s : S
        }
        printf "%.6g\t%.6g\n", r, sqrt(V * V / (U * U + S * S / r ^ 4))
    }
}' > "$OUT/den-hartog-limit.tsv"

# A point is near the limit if it lies between the limits of its neighbours' r, or a step from them.
awk -F '\t' 'function at(r) { return limit[sprintf("%.4f", r)] }
    function max(a, b) { return a > b ? a : b }
    function min(a, b) { return a < b ? a : b }
    NR == FNR { limit[sprintf("%.4f", $1)] = $2; next }
    /^#/ || $2 - 0.005 < 0.1024 || $2 + 0.005 > 1.8026 { next }
    $NF != "ok" { undecided++; next }
    { n++; stops = $4 > 0 || $5 == 0 }
    stops != ($3 > at($2)) {
        wrong++
        far += $3 < min(at($2 - 0.005), min(at($2), at($2 + 0.005))) - 0.01 ||
            $3 > max(at($2 - 0.005), max(at($2), at($2 + 0.005))) + 0.01
    }
    END {
        printf "%d points; %d on the wrong side of the limit of Den Hartog, %d of them farther than\n", n, wrong, far
        printf "a grid step from it; %d more have not come to a period in 2000 cycles\n", undecided
    }' "$OUT/den-hartog-limit.tsv" "$OUT/den-hartog.tsv"

ss-sweep --threads "$THREADS" --shoot --measure microslips,transition,period \
    --vary contact_damping=5:200:121:log --vary friction=0.41:1.37:97 \
    -o "$OUT/microslips.tsv" compliant-light

ss-sweep --threads "$THREADS" --max-cycles 3000 --measure period,x_max,amplitude \
    --vary base_frequency=0.4:0.66:131 --vary static_friction=0.3:0.8:101 shaw |
    awk -F '\t' -v OFS='\t' '/^# columns/ { sub("x_max", "offset") }
        !/^#/ && $5 != "-" { $5 = $5 - $6 > 1e-6 ? $5 - $6 : 0 } { print }' > "$OUT/symmetry.tsv"

ss-sweep --threads "$THREADS" --measure model_error_a_rms,model_error_a,model_error_x \
    --vary contact_stiffness=3e4:3e7:49:log --vary contact_damping=3:3000:37:log \
    -o "$OUT/coulomb.tsv" compliant-light

ss-sweep --threads "$THREADS" --simulate --max-cycles 3000 --strobe 150 --measure x_phase,lyapunov \
    --vary base_frequency=0.44:0.74:601 -o "$OUT/chaos.tsv" chaos

for form in png pdf; do
    ss-plot --map base_frequency,x_phase,lyapunov --title 'The way to chaos, f_s = 4 f_k' "$OUT/chaos.tsv" \
        -o "$OUT/chaos.$form"
    ss-plot --map base_frequency,friction,stops,amplitude --line "$OUT/den-hartog-limit.tsv" \
        --title 'Stops a cycle, amplitude; the limit of Den Hartog' "$OUT/den-hartog.tsv" \
        -o "$OUT/den-hartog.$form"
    ss-plot --map contact_damping,friction,microslips,transition \
        --title 'Micro-slips a half-cycle, transition frequency' "$OUT/microslips.tsv" \
        -o "$OUT/microslips.$form"
    ss-plot --map base_frequency,static_friction,period,offset \
        --title 'Period, and how far from symmetric' "$OUT/symmetry.tsv" -o "$OUT/symmetry.$form"
    ss-plot --map contact_stiffness,contact_damping,model_error_a_rms \
        --title 'Coulomb friction in place of a compliant contact' "$OUT/coulomb.tsv" -o "$OUT/coulomb.$form"
done
echo "The maps: $OUT/*.png, *.pdf; their numbers: $OUT/*.tsv"
