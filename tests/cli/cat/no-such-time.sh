# --time of a column that is not there: the columns that are, of a wide table as many as a line holds, each whole.
printf 'a,b\n1,2\n3,4\n' | ss-cat --time x || echo "exit $?"
awk 'BEGIN { for (r = 0; r < 3; r++) for (c = 1; c <= 60; c++) printf "%s%s", r ? r : "channel_" c, c < 60 ? "," : "\n" }' > wide.csv
! ss-cat --time x wide.csv 2> message || echo taken
awk '{ sub(/.*there are /, ""); n = split($0, name, /,? /) }
     END { for (i = 1; i < n; i++) if (name[i] != "channel_" i) print i, name[i]
           print name[n], (length($0) <= 300), (n > 20) }' message
