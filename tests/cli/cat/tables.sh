# What recorders export, and what is not guessed.
printf 'X_Value\tforce\taccel\tComment\n0.0\t1\t2\n0.5\t3\t4\n' > labview.lvm
ss-cat --column FORCE labview.lvm
printf 't;Channel A (m/s\262)\n0,0;1\n0,5;2\n' > latin1.csv
ss-cat --column 'Channel A' latin1.csv
printf 'deflection,force\n1,1\n2,3\n3,9\n' > loop.csv
ss-cat loop.csv || echo $?
ss-morlet loop.csv || echo $?
ss-cat --time deflection loop.csv
printf 't;x\n0,5;1,5\n1.0;2,5\n' > marks.csv
ss-cat marks.csv || echo $?
printf 't;x\n0;1\n1;2\n1;3\n' > stamps.csv
ss-cat stamps.csv || echo $?
ss-cat --rate 2 --column x stamps.csv
ss-cat -o own.h5 labview.lvm
ss-cat --rate 5 own.h5 || echo $?
ss-cat --time force own.h5 || echo $?
ss-cat --rate 2 --column accel own.h5
awk 'BEGIN { for (i = 0; i < 5000; i++) printf "a%s", i < 4999 ? "," : "\n"
             for (i = 0; i < 5000; i++) printf "1%s", i < 4999 ? "," : "\n" }' > wide.csv
ss-cat --rate 1 --format au wide.csv || echo $?
ss-cat --rate 1 wide.csv | awk '/columns/ { print NF, $5, $NF }'
