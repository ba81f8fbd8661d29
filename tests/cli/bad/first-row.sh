# Cells that are missing in the first row of numbers, of whatever columns: the row is neither one of units nor
# narrower than its names.
for row in ',1,2' '0,,2' '0,1,' '0,,' ',,2'; do
    echo "-- $row"
    printf 't,x,y\n%s\n0.1,2,3\n0.2,3,4\n' "$row" > run.csv
    ss-cat -q run.csv || echo $?
    ss-cat --gaps=interpolate run.csv | grep -v '^#'
done
for text in ',1,2\n0.1,2,3\n' 't;x\n0;\n0,1;2\n' 't,x,y\n0,1,\n.1,2,\n.2,3,\n.3,4,5\n'; do
    # shellcheck disable=SC2059  # the text is a format
    printf "$text" | ss-cat -q || echo $?
done
# a column without any number is left out
printf 't,x,note\n0,1,\n.1,2,\n.2,3,\n' | ss-cat
printf 't,x,y\ns,1,1\n0,1,2\n.1,2,2\n' | ss-cat | sed -n '/^# columns/p'
