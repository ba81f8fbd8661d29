# Events of measured recordings: one slip of a rock fault, in whatever it is measured and by whatever
# converter; drops of a paper slider's force by their height, wrong samples left out; slips of a string.
cd "$SRC/../shared/data/measured" 2> /dev/null || { echo "no measured recordings"; exit 77; }
rock=rock_labquake_fb03-087_event043.csv
paper=paper_friction_k168_v42.csv
number() { awk -v key="# $1:" 'index($0, key) == 1 { print $(NF - 1) }'; }
near() { awk -v want="$1" -v allow="$2" '{ print $1 - want <= allow && want - $1 <= allow ? "yes" : $1 }'; }

# Creep from 91.27 s, fast slip from 91.296 s with its peak at 91.306 s, at rest by 91.34 s.
echo 'one event'
for column in slip_mm slip_velocity_mm_s; do
    ss-features --column $column $rock | awk '
        !/^#/ { print ($1 > 91.268 && $1 < 91.3 && $2 > 91.306 && $2 < 91.342) }'
    ss-cat -c $column --from 91.25 --to 91.34 $rock | ss-features | number transitions
    ss-cat -c $column $rock | ss-noise --snr 20 | ss-features | number transitions
done
ss-cat -c slip_mm $rock | ss-noise --bits 10 --range 0.05 | ss-features | number transitions
ss-cat -c slip_velocity_mm_s $rock | ss-noise --bits 10 --range 8 | ss-features | number transitions

echo 'drops'
for count in '0.012 34' '0.02 30' '0.03 24'; do
    ss-features --column F_norm --drop "${count% *}" $paper | number transitions | near "${count#* }" 1
done

command -v sox > /dev/null || { echo "no sox"; exit 77; }
echo 'slips a second'
sox double_bass_arco_g1_mf_down.wav -t au - 2> /dev/null | ss-features | number slip_rate | near 48.9 0.2
