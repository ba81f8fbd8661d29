# Samples that are missing, and time stamps that are uneven.
printf 't,x,y\n0,1,1\n0.1,2,\n0.2,3,3\n0.5,6,6\n0.6,nan,7\n' > gap.csv
ss-cat gap.csv || echo $?
ss-cat --gaps=split gap.csv
ss-cat --gaps=interpolate gap.csv
printf 't,x\n0,1\n0.1,2\n0.2,3\n0.4,5\n0.5,6\n' | ss-cat || echo $?
printf 't,x,y\n0,,1\n1,NA,2\n' | ss-cat --gaps=split || echo $?
printf 't,x\n0,1\n1,2\n1e9,3\n' | ss-cat --gaps=split || echo $?

echo '-- uneven'
printf 't,x\n0,0\n0.12,0.12\n0.2,0.2\n0.28,0.28\n0.4,0.4\n0.5,0.5\n' > jitter.csv
ss-cat jitter.csv || echo $?
ss-cat --resample 5 jitter.csv
(cat jitter.csv; printf '8,8\n8.1,8.1\n') > apart.csv
ss-cat --resample 5 apart.csv || echo $?
ss-cat --resample 1 --gaps=split apart.csv
ss-signal sine --duration .005 | ss-cat --resample 1000
ss-signal sine --duration .0005 | ss-cat --resample 1000 || echo $?
ss-cat --resample 0 gap.csv || echo $?
ss-cat --gaps=hide gap.csv || echo $?
echo '-- both'
awk 'BEGIN { print "t,x"; for (i = 0; i < 60; i++) if (i < 20 || i > 39)
    print (i + 0.3 * (i % 3 - 1)) / 10 "," i }' > both.csv
ss-cat --gaps=interpolate both.csv || echo $?
ss-cat --resample 10 --gaps=interpolate both.csv | sed -n '/^# rate/p;/^# gaps/p;$p'

# What is missing in a column that nobody asks for is no gap: a slow channel, a word for an overload.
printf 't,a,temp,b\n0,1,20,5\n0.1,2,,6\n0.2,3,,\n0.3,4,OVL,8\n' > slow.csv
ss-cat -c a slow.csv
ss-cat -c 1 -c 3 slow.csv || echo $?
ss-cat -q -c b --gaps=interpolate slow.csv
ss-cat -q -c 2 --gaps=split slow.csv || echo $?
ss-cat -q -c c slow.csv || echo $?
printf 't;a;temp\n0;1;\n0,5;2;\n1;3;20\n' | ss-cat -c a

# A gap in the first row, in its last column: it is a row of data all the same.
for s in ',' ';'; do
    printf "t${s}a${s}b\n0${s}7${s}\n0.5${s}5${s}7\n" | ss-cat --gaps split - | tail -n 3
    printf "t${s}a\n0${s}\n0.5${s}5\n" | ss-cat --gaps split - | tail -n 3
    printf "t${s}a${s}\n0${s}1${s}\n0.5${s}5${s}\n" | ss-cat --gaps split - | tail -n 3
done
