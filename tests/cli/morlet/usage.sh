# Wrong usage is one line on standard error and exit 2.
for options in "--center 1" "--center x" "--voices 0" "--voices 1.5" "--step 0" "--step -1" \
        "--accuracy 1" "--accuracy nan" "--norm l3" "--method dft" "--detrend cubic" "--octaves 3" \
        "--octaves 3:2" "--octaves :" "--fmin 0" "--fmin 2 --fmax 1" "--octaves 1:2 --fmin 1" \
        "--dyadic --voices 2" "-o c.png" "a b" "--stream" "--stream --fmin 1 --detrend mean" \
        "--stream --fmin 1 --check" "--stream --fmin 1 --method quadrature" "--stream --fmin 1 -o c.png" "--format h5" \
        "--inverse --fmin 2" "--inverse --stream"; do
    # shellcheck disable=SC2086  # options are a list
    ss-morlet $options < /dev/null 2>&1 || echo "exit $?"
done
