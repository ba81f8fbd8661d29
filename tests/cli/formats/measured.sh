cd "$SRC/../shared/data/measured" 2> /dev/null || { echo "no measured recordings"; exit 77; }
for f in band_friction_damper_1hz_20lb paper_friction_k168_v42 paper_friction_k168_v4300 \
        rock_labquake_fb03-087_event043; do ss-cat "$f.csv" | sed -n '2,5p'; done
ss-cat double_bass_arco_g1_mf_down.wav | wc -l
command -v sox > /dev/null || { echo "no sox"; exit 77; }
sox double_bass_arco_g1_mf_down.wav -t au - 2> /dev/null | ss-cat | wc -l
