# Signals with nothing to see still give a picture, or say what is missing.
command -v gnuplot > /dev/null || { echo "no gnuplot"; exit 77; }
ss-signal step --amplitude 0 | ss-plot -o zero.png
ss-signal step --amplitude 0 --duration 2 | ss-morlet -o zero.h5
ss-contour zero.h5 -o zero-contour.png
ss-signal sine --duration 0.0005 | ss-plot -o one.png
ls
ss-signal sine --duration 0 | ss-plot || echo $?
ss-plot --from 3 --to 2 zero.h5 || echo $?
ss-plot --from 30 zero.h5 || echo $?
ss-contour --from 30 zero.h5 || echo $?
