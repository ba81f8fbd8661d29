# 10^8 samples as AU through a pipe, on each kind of grid, stay under 200 MB, as do fewer into HDF5
# whose length is not known.
[ "$(uname)" = Linux ] || { echo "other systems count memory in other units"; exit 77; }
[ -z "$SAN" ] || { echo "sanitizers need memory of their own"; exit 77; }
$CCLD -o high_water "$SRC/tests/stop/high_water.c"
below() {       # KIB COMMAND ...: takes less; what it writes is not wanted
    limit=$1
    shift
    most=$(./high_water "$@" 2>&1 > /dev/null)
    [ "$most" -lt "$limit" ] || echo "$*: $most KiB"
}
watch() {       # SECONDS OPTIONS ...: of a signal of 10 kHz
    ss-signal noise --rate 10000 --duration "$1" --format au > in &
    shift
    below 195312 ss-morlet --stream "$@" < in
    wait
}
mkfifo in
watch 10000 --dyadic --octaves=-8:4 --format au
watch 10000 --dense --voices 1 --octaves=-8:1 --format au
watch 10000 --voices 2 --octaves=-8:1.5 --format au
watch 200 --dense --voices 2 --octaves=-8:1.5 -o x.h5
watch 1000 --voices 2 --octaves=-8:1.5 -o x.h5
rm x.h5

# The last seconds of a live signal: as much after 10^7 samples as after 10^5.
for seconds in 100 10000; do
    ss-signal noise --rate 1000 --duration $seconds --format au > in &
    below 50000 ss-contour -q --follow x.png 2 < in
    wait
done
rm x.png

# Delimited text in a file, of one kind or another, and HDF5, in constant memory.
ss-signal noise --rate 10000 --duration 1000 --format csv > long.csv
{ tr ',' ';' < long.csv | tr . ,; } > comma.csv
for command in ss-cat 'ss-noise --rms 1'; do
    below 50000 $command -o long.h5 long.csv
done
for file in long.csv comma.csv long.h5 long.h5:/signal/a; do
    for command in 'ss-cat --format au' 'ss-filter --high-pass 10 --format au' 'ss-noise --rms 1 --format au' \
            'ss-noise --snr 9 --format au' \
            'ss-morlet --stream --voices 2 --octaves=-8:1.5 --format au'; do
        below 50000 $command $file
    done
done

# So are delimited text through a pipe, with gaps and at another rate, and one of several tables, and HDF5 with
# gaps; numbers that are read again are in a file.
awk -F , 'NR % 1000 != 7' long.csv > gaps.csv
{ printf '\223NUMPY\1\0v\0%-117s\n' "{'descr': '<f8', 'fortran_order': False, 'shape': (2, 5000000), }"
    head -c 80000000 /dev/zero; } > long.npy
{ cat long.csv; printf 'Step 2\nt,b\n0,1\n1,2\n'; } > tables.csv
for command in 'ss-cat --format au -' 'ss-morlet --stream --voices 2 --octaves=-8:1.5 --format au' \
        'ss-cat --format au --gaps=interpolate gaps.csv' 'ss-cat --format au --resample 9000 gaps.csv' \
        'ss-cat --format au --gaps=split --resample 12000 gaps.csv' 'ss-cat --format au --table 1 tables.csv' \
        'ss-cat --format au --gaps=split long.h5' 'ss-noise -q --rms 1 --format au --resample 9000 long.h5' \
        'ss-noise --snr 9 --format au' 'ss-cat --rate 1e4 --format au long.npy'; do
    cat long.csv > in &
    below 50000 $command < in
    wait
done
rm gaps.csv tables.csv long.npy

# A picture of each form, of files and through a pipe.
for file in long.csv long.h5; do
    for form in '' "--over $file" '--xy a,a' --spectrum; do
        below 100000 ss-plot $form -o long.gp $file
    done
done
for form in '' '--xy a,a' --spectrum; do
    ss-signal noise --rate 10000 --duration 10000 --format au > in &
    below 100000 ss-plot $form -o long.gp < in
    wait
done
rm in long.gp long.csv comma.csv long.h5
