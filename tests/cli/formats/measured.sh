cd "$SRC/../shared/data/measured" 2> /dev/null || { echo "no measured recordings"; exit 77; }
for f in *.csv; do ss-cat "$f" | sed -n '2,5p'; done
command -v sox > /dev/null || { echo "no sox"; exit 77; }
sox double_bass_arco_g1_mf_down.wav -t au - 2> /dev/null | ss-cat | wc -l
