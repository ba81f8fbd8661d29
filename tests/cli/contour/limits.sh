# Frequencies that coefficients do not have: the message says which were asked for, and which there are.
ss-sim --set duration=2 --columns t,a compliant-light | ss-morlet --fmin 5 -o run.h5
ss-contour --fmin 10 --fmax 100 run.h5 | sed -n 's/ *#.*//; /^fm[inax]* =/p'
ss-contour --fmin 600 run.h5 > out || echo $?
ss-contour --fmax 2 run.h5 > out || echo $?
