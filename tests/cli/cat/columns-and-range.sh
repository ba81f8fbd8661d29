printf "# stickslip signal 1\n# rate: 10\n# columns: t/s x/m v/(m/s)\n0\t1\t2\n0.1\t3\t4\n0.2\t5\t6\n" | ss-cat -c v -c x --from 0.1
# where nothing is left, no header is written either
printf "# stickslip signal 1\n# rate: 10\n# columns: t/s x/m\n0\t1\n0.1\t3\n" | ss-cat --from 7 || echo "exit $?"

echo "-- names"
printf 't,x (m),y\n0,1,2\n1,3,4\n' > names.csv
ss-cat --name x=left --name 2=right names.csv
for wrong in x x= =y z=y y=x x=t; do ss-cat --name $wrong names.csv || echo "exit $?"; done
