# A file without a signal is drawn without it; a damaged signal is not passed over.
python3 -c 'import h5py' 2> /dev/null || { echo "no Python with h5py"; exit 77; }
ss-signal ringdown --duration 1 | ss-morlet --dyadic -o run.h5
ss-contour -o whole.gp run.h5
python3 -c 'import h5py; del h5py.File("run.h5", "r+")["signal/t"]'
ss-contour -o damaged.gp run.h5 || echo $?
python3 -c 'import h5py; del h5py.File("run.h5", "r+")["signal"]'
ss-contour -o without.gp run.h5
ls
