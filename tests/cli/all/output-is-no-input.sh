# No output takes the place of a file that is read, whichever option names that, by whatever name: each
# try is refused as wrong usage, and the file stays as it was.
command -v gnuplot > /dev/null || { echo "no gnuplot"; exit 77; }
ss-sim --set settle=2 --set duration=1 compliant-light > signal
ss-sim --events --set settle=2 --set duration=1 compliant-light > events
ss-cat signal -o signal.h5
ss-cat -c a signal > one
ss-sim --columns t,z --set settle=0 --set duration=1 coulomb > base
ss-morlet --dyadic signal > coefficients
ss-morlet --dyadic signal -o coefficients.h5
ss-features signal > features

ss-sweep -m amplitude --vary mass=2:3:4 --vary friction=1:2:4 coulomb > sweep
printf '2\t1\n3\t2\n' > line
cp "$SRC/data/scenes/compliant-light.scene" scene

tries=0
# refused FILE ENDING COMMAND: with a copy of FILE as $in, and $out, another name of it.
refused() {
    file=$1 ending=$2
    shift 2
    for alias in same dotted symbolic hard; do
        cp "$file" "in$ending"
        in=in$ending out=out$ending status=0
        case $alias in same) out=$in ;; dotted) out=./$in ;; symbolic) ln -s "$in" "$out" ;;
            hard) ln "$in" "$out" ;; esac
        eval "$*" > /dev/null 2> words || status=$?
        if [ $status != 2 ] || ! grep -q 'both input and output' words; then
            echo "$*, $alias: exit $status"
            cat words
        fi
        cmp "$file" "$in" || echo "$*, $alias: the input has changed"
        tries=$((tries + 1))
        rm -f "in$ending" "out$ending"
    done
}
# shellcheck disable=SC2016  # for eval
{
for end in .tsv .au .h5; do
    refused signal    $end 'ss-cat $in -o $out'
    refused signal    $end 'ss-cat -o $out < $in'
    refused signal.h5 $end 'ss-cat $in -o $out'
    refused signal.h5 $end 'ss-cat $in:/signal/a -o $out'
    refused signal    $end 'ss-cat --resample 100 -q $in -o $out'
    refused signal    $end 'ss-noise --rms 1 $in -o $out'
    refused signal    $end 'ss-noise --snr 1 -o $out < $in'
    refused signal    $end 'ss-morlet --dyadic $in -o $out'
    refused signal    $end 'ss-morlet --dyadic -o $out < $in'
    refused signal    $end 'ss-morlet --stream --fmin 9 $in -o $out'
    refused signal.h5 $end 'ss-morlet --stream --fmin 9 $in -o $out'
    refused coefficients    $end 'ss-morlet --inverse $in -o $out'
    refused coefficients.h5 $end 'ss-morlet --inverse $in -o $out'
    refused scene     $end 'ss-sim --set duration=0.1 $in -o $out'
    refused base      $end 'ss-sim --set duration=0.1 --set settle=0 --base $in:z coulomb -o $out'
done
for end in .gp .svg; do
    refused signal    $end 'ss-plot $in -o $out'
    refused signal.h5 $end 'ss-plot $in:/signal/a -o $out'
    refused signal    $end 'ss-plot --over $in signal -o $out'
    refused sweep     $end 'ss-plot --map mass,friction,amplitude $in -o $out'
    refused line      $end 'ss-plot --map mass,friction,amplitude --line $in sweep -o $out'
    refused coefficients    $end 'ss-contour $in -o $out'
    refused coefficients    $end 'ss-contour -o $out < $in'
    refused coefficients.h5 $end 'ss-contour $in -o $out'
    refused signal    $end 'ss-contour --signal $in coefficients -o $out'
    refused signal.h5 $end 'ss-contour --signal $in:/signal/a coefficients -o $out'
    refused events    $end 'ss-contour --events $in coefficients -o $out'
    refused features  $end 'ss-contour --features $in coefficients -o $out'
    refused scene     $end 'ss-trade --budget 1e-3 $in -o $out'
    refused one       $end 'ss-trade --budget 1e-3 $in -o $out'
done
refused scene  .tsv 'ss-sim --events --set duration=0.1 $in -o $out'
refused signal .tsv 'ss-features $in -o $out'
refused signal .tsv 'ss-backbone -c a $in -o $out'
refused signal .tsv 'ss-rank -c a $in coulomb -o $out'
refused scene  .tsv 'ss-rank -c a signal $in -o $out'
refused signal .tsv 'ss-rank --motion x -c f $in --residual $out'
refused scene  .scene 'ss-rank --fit -c a signal $in -o $out'
refused scene  .tsv 'ss-sweep -m amplitude --vary mass=2:3:2 $in -o $out'
refused scene  .tsv 'ss-sweep -m amplitude --vary mass=2:3:2 --resume $out $in'
refused scene  .tsv 'ss-trade --budget 1e-3 $in -o $out'
refused signal .tsv 'ss-noise --rms 1 $in >> $out'
refused signal .tsv 'ss-cat < $in >> $out'
refused scene  .tsv 'ss-sim --set duration=0.1 $in >> $out'
}
echo "$tries tries"

echo "--- two outputs of one name, there before and not"
ss-rank --motion x -c f --residual new.tsv -o new.tsv signal || echo $?
ss-rank --motion x -c f --residual new.tsv -o ./new.tsv signal || echo $?
: > new.tsv
ss-rank --motion x -c f --residual new.tsv -o new.tsv signal || echo $?
echo "--- what is no file may be both"
ss-cat signal < /dev/null > /dev/null
ss-cat < /dev/null > /dev/null || echo $?
echo "--- no option names a file that is not tried above"
for tool in "$BUILD"/bin/ss-*; do "$tool" --help; done | sed -n 's/.*--\([a-z]*\)=FILE.*/\1/p' | sort -u
