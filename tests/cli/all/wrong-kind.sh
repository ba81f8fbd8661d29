# A file of another kind than the one wanted: what it is, and what reads it.
ss-sim --set duration=0.5 compliant-light -o signal.h5
ss-cat signal.h5 -o signal.tsv
ss-cat signal.h5 -o signal.au
ss-morlet --octaves=-5:-4 signal.h5 -o coefficients.h5
ss-morlet --octaves=-5:-4 signal.h5 -o coefficients.tsv
ss-morlet --octaves=-5:-4 signal.h5 -o coefficients.au
ss-features signal.h5 -o features.tsv 2> /dev/null
ss-sim --events compliant-light > events.tsv
ss-sweep --vary mass=1:2:3 coulomb > sweep.tsv
ss-trade --budget 0.01 coulomb > trade.tsv
echo '# stickslip ranking 1' > ranking.tsv
{ echo '# mine'; ss-sim --list coulomb; } > my.scene
ss-contour coefficients.h5 > plot.gp
printf '\211PNG\r\n\032\n' > plot.png
printf '%%PDF-1.5\n' > plot.pdf
printf '<?xml version="1.0"?>\n' > plot.svg
printf 'RIFF\0\0\0\0WAVEfmt ' > sound.wav
printf 'ID3\003\0aaaaaaaaaaa' > sound.mp3
printf '\037\213\010\0aaaaaaaaaaaaaa' > signal.tsv.gz
printf 'BZh91AY&SY\0aaaaaaaaaaaaaa' > signal.tsv.bz2
printf '\3757zXZ\0aaaaaaaaaaaaaa' > signal.tsv.xz
printf '\050\265\057\375aaaaaaaaaaaaaa' > signal.tsv.zst
printf 't\0,\0x\0\n\0001\0,\0' > no-mark.csv
printf '\377\376t\0,\0x\0\n\0001\0,\0' > utf16.csv
printf 'PK\003\004aaaaaaaaaaaaaaaaaaaaaaa\n' > book.xlsx
printf '\320\317\021\340aaaaaaaaaaaaaaaaaaaaaaa\n' > book.xls
printf 'MATLAB 5.0 MAT-file, Platform: GLNXA64\0\0' > old.mat
printf 'TDSm\016\0\0\0aaaaaaaaaaaaaa' > log.tdms
printf 'PAR1\025\004\025\020aaaaaaaa' > run.parquet
printf 'ARROW1\0\0\377\377\377\377' > run.feather
printf '{"t": [0, 1], "a": [2, 3]}\n' > run.json
printf '\200\004\225\025\0\0\0\0\0\0\0]' > run.pkl
printf 'FORM\0\0\0\056AIFFCOMM' > run.aiff
printf 'CDF\001\0\0\0\0aaaaaaaaaaaaaa' > log.nc
echo 'hello world' > hello.txt
printf 't,a\n0,1\n0.1,2\n' > table.csv
: > empty

refused() {     # COMMAND ...: exit 1, one line, nothing on standard output
    status=0
    "$@" > out || status=$?
    [ "$status" = 1 ] && [ ! -s out ] || echo "$*: exit status $status"
}
for file in coefficients.tsv coefficients.au features.tsv events.tsv sweep.tsv trade.tsv ranking.tsv \
        my.scene plot.gp plot.png plot.pdf plot.svg sound.wav sound.mp3 run.parquet run.feather run.json \
        run.pkl run.aiff signal.tsv.gz \
        signal.tsv.bz2 signal.tsv.xz signal.tsv.zst utf16.csv no-mark.csv \
        book.xlsx book.xls old.mat log.tdms log.nc hello.txt empty; do
    refused ss-cat $file
done
ss-noise --snr 20 < signal.h5 > out && echo 'HDF5 from a stream?'
for tool in ss-features ss-backbone ss-morlet ss-plot ss-rank ss-trade 'ss-noise --snr 20'; do
    refused $tool coefficients.tsv
done
refused ss-contour --signal my.scene coefficients.h5
for file in features.tsv plot.png sound.wav hello.txt empty; do
    refused ss-contour $file
done
for file in signal.tsv signal.au signal.h5 features.tsv plot.png sound.wav hello.txt empty; do
    refused ss-morlet --inverse $file
done
for tool in ss-sim 'ss-sweep --vary mass=1:2:3' 'ss-rank signal.tsv'; do
    for file in signal.tsv signal.au signal.h5 coefficients.tsv plot.gp plot.png table.csv \
            hello.txt empty; do
        refused $tool $file
    done
done
for file in signal.h5 coefficients.au events.tsv plot.svg hello.txt empty; do
    refused ss-plot --map mass,stops,stick $file
done
refused ss-plot --map mass,amplitude,stick --line plot.png sweep.tsv
refused ss-contour --events features.tsv coefficients.h5
refused ss-contour --features events.tsv coefficients.h5
