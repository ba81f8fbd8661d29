# Recorded pulls of paper on paper, force over weight: at least two of the four slow and middle ones are
# answered, and k/m and loading stand beside the nominal ones.
data=$SRC/../shared/data/measured
[ -d "$data" ] || { echo "no measured recordings"; exit 77; }
for pull in '168 42' '168 1100' '1002 1100' '2254 42'; do
    # shellcheck disable=SC2086  # stiffness and um/s
    set -- $pull
    ss-rank -q --fit --as s -c F_norm --scale 0.30117 --unit N -s mass=0.0307 -s stiffness="$1" \
        -s base_amplitude=0 -s base_velocity="$2e-6" "$data/paper_friction_k$1_v$2.csv" coulomb > fitted 2> err ||
        sed -n 's/.*: \(none of these\|cannot tell\): .*/\1/p' err
    awk '$2 == "k/m" || $2 == "loading" { print $2, ($3 > 0 && $5 > 0 && /given: /) }
         $2 == "loading" { print (100 * $3 / $10 - 100)^2 < 400 }' fitted
done
