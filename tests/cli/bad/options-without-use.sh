# --table and --time-unit are refused where they mean nothing, as --rate and --time are, and by name of the file.
refused() { "$@" > out && echo "taken: $*"; [ ! -s out ] || echo "$*: rows before the refusal"; }
ss-signal --duration .1 -o run.tsv sine
for form in au csv h5; do ss-cat -o run.$form run.tsv; done
grep -v '^# rate' run.tsv | sed 's/^# columns: t.s /# columns: /; s/^[^#][^\t]*\t//' > no-clock.tsv
# WAV: 16 bits, one channel, 8000 Hz, four samples
printf 'RIFF\054\0\0\0WAVEfmt \020\0\0\0\001\0\001\0\100\037\0\0\200\076\0\0\002\0\020\0data\010\0\0\0\1\0\2\0\3\0\4\0' > run.wav
# NumPy: two columns of three rows
{ printf '\223NUMPY\001\0\166\0'
  printf "%-117s\n" "{'descr': '<f8', 'fortran_order': False, 'shape': (3, 2), }"
  printf '\0\0\0\0\0\0\0\0\0\0\0\0\0\0\360\077\0\0\0\0\0\0\360\077\0\0\0\0\0\0\0\100\0\0\0\0\0\0\0\100\0\0\0\0\0\0\360\077'; } > run.npy
printf 'LabVIEW Measurement\t\r\nSeparator\tTab\r\n***End_of_Header***\t\r\n\t\r\nChannels\t1\t\r\nSamples\t3\t\r\nX_Dimension\tTime\t\r\nX0\t0\t\r\nDelta_X\t0.001\t\r\n***End_of_Header***\t\r\nX_Value\tVoltage\tComment\r\n\t1\t\r\n\t2\t\r\n\t3\t\r\n' > run.lvm
for file in run.tsv run.au run.wav run.h5 run.h5:/signal/a run.lvm; do
    refused ss-cat --table 99 $file
    [ $file = run.lvm ] || refused ss-cat --table 1 $file
    refused ss-cat --time-unit ms $file
done
refused ss-cat --rate 10 --table 1 no-clock.tsv
refused ss-cat --rate 10 --table 1 run.h5:/signal/a
refused ss-cat --rate 10 --table 1 run.npy
refused ss-cat --table 1 - < run.tsv
for tool in ss-features ss-morlet ss-contour ss-plot 'ss-noise --rms 1'; do
    # shellcheck disable=SC2086  # with its options
    refused $tool --table 1 run.wav
done
# where they mean something
ss-cat --table 1 run.lvm | grep '^# rate'
ss-cat --table 1 run.csv | cmp - run.tsv
ss-cat --time-unit ms run.csv | grep '^# rate'
ss-cat --time 1 --time-unit ms run.npy | grep '^# rate'
ss-cat --rate 10 no-clock.tsv | grep '^# rate'
