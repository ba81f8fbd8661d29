[ -c /dev/full ] || { echo "no /dev/full"; exit 77; }
ss-signal sine > /dev/full || echo $?
ss-signal sine --format au > /dev/full || echo $?
ss-signal sine | ss-cat > /dev/full || echo $?
ss-signal sine | ss-noise --rms 1 > /dev/full || echo $?
ss-signal sine | ss-filter --low-pass 20 > /dev/full || echo $?
ss-signal sine | ss-noise --snr 1 > /dev/full || echo $?
ss-signal --help > /dev/full || echo $?
ss-cat --version > /dev/full || echo $?
ss-signal sine -o /dev/full 2> /dev/null || echo $?
for form in tsv au; do ss-sim --format $form coulomb > /dev/full || echo $?; done
for what in --events --list --help --version; do ss-sim $what coulomb > /dev/full || echo $?; done
ss-trade --version > /dev/full || echo $?
ln -s /dev/full full.tsv
ss-sim -o full.tsv coulomb || echo $?
ss-sim --events -o full.tsv coulomb || echo $?
