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

echo '-- words at the end'
printf 't,x\n0,1\n0.5,2\n\nEnd of data\nNot averaged\n' | ss-cat
for end in 'End,of' 'Max,2' 'End\n1,3' 'End 5'; do
    printf "t,x\n0,1\n0.5,2\n$end\n" | ss-cat -q || echo $?
done
printf 't;x;y\n0;1;2\n0,5;3;4\nEnde der Messung;;\nProbe 7;;\n' | ss-cat
printf 't;x;y\n0;1;2\n0,5;-;4\n1;---;6\n1,5;7;8\n' > dashes.csv
ss-cat dashes.csv || echo $?
ss-cat --gaps split dashes.csv
printf 't (s),mu (-),r (1)\n0,1,2\n1,2,3\n' | ss-cat -c mu -c r --unit mu=1 | grep columns
echo '-- dates of spreadsheets'
for second in 04/05 03/06 03/07; do
    printf 'when;x\n03/05/2024 23:59:59,5;1\n%s/2024 0:00:00,0;2\n' $second | ss-cat || echo $?
done
printf 'Date,Time,x\n03/05/2024,1:59:59.5 PM,1\n03/05/2024,2:00:00.0 PM,2\n' | ss-cat -q
printf 'when;x\n5.3.2024 23:59:59,5;1\n6.3.2024 0:00:00,0;2\n' | ss-cat -q
printf 'Time,x\n13:59:59.5 PM,1\n14:00:00.0 PM,2\n' | ss-cat || echo $?
echo '-- quotes'
printf '"t","x"\n"0,0","1,5"\n"0,5","2,5"\n' | ss-cat || echo $?
printf 't,x\n0,1\n0.5,"2"5x\n' | ss-cat || echo $?
