# Wrong usage is exit 2, wrong data exit 1, each with a line.
ss-sim --columns a coulomb > a.tsv
for options in '-p -1' '-p 100' '-F 0' '-a y' '--fit a.tsv coulomb state-variable' '-o a.png a.tsv' \
               '-s mass=0 a.tsv' '-s alpha=1 a.tsv coulomb' '--nonsense'; do
    # shellcheck disable=SC2086  # several words
    ss-rank $options > /dev/null || echo $?
done
ss-rank -c force a.tsv || echo $?
ss-rank a.tsv absent.scene || echo $?
ss-rank absent.tsv || echo $?
ss-rank a.tsv -s base_amplitude=0 || echo $?
ss-rank --fit a.tsv coulomb || echo $?
ss-rank --fit -o fitted.scene a.tsv 2> err || echo $?
sed 's/leaves .*/leaves .../' err >&2
rm err
ls
