# --resample is not suggested where it was given, or cannot help.
refused() { "$@" || echo "exit $?"; }
printf 't,x\n0,1\n1,2\n2,2\n3.5,3\n4.5,4\n5.5,5\n' > uneven.csv
printf 't,x\n0,1\n1,2\n1,2\n2,3\n' > equal.csv
printf 't,x\n0,1\n2,2\n1,2\n3,3\n' > back.csv
for file in uneven equal back; do
    refused ss-cat -q --time-unit s $file.csv
    refused ss-cat -q --time-unit s --resample 1 $file.csv
done
