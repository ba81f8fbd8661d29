# Our files as Octave and h5dump read them: the same numbers to the last digit.
ss-sim compliant-light -o run.h5
ss-morlet --dense --fmin 20 --fmax 200 run.h5 -o w.h5
ss-cat -c a run.h5 | awk '!/^#/ { print $2 }' > ours
found=0
if command -v h5dump > /dev/null; then
    found=1
    h5dump -d /signal/a -m %.17g -y -w 1 run.h5 | sed -n 's/^ *\([-0-9][-0-9.e]*\),*$/\1/p' > theirs
    paste ours theirs | awk 'NF != 2 || $1 != $2 { print "h5dump:", NR, $0 }'
fi
if command -v octave > /dev/null; then
    found=1
    octave -q --no-gui --no-init-file --eval "
        s = load('-hdf5', 'w.h5');
        printf('%.17g\n', s.signal.a);
        f = fopen('shape', 'w');
        fprintf(f, '%d %d %d %d\n', size(s.wavelet.re), numel(s.wavelet.frequency), numel(s.signal.t));
        fclose(f);" > theirs 2> log
    paste ours theirs | awk 'NF != 2 || $1 != $2 { print "Octave:", NR, $0 }'
    awk '$1 != 6000 || $2 != $3 || $4 != 6000' shape
fi
[ $found = 1 ] || { echo "neither h5dump nor Octave"; exit 77; }
