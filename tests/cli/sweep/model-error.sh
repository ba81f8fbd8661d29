# The error of a simpler model is a measure of those that have one only.
for scene in compliant-light coulomb; do
    ss-sweep --vary friction=.5:1:2 --measure model_error_x "$scene" | awk '!/^#/ { print $NF, ($3 > 0 && $3 < 1) }' || echo "exit $?"
done
