# A thousand made-up strings, from every place where text comes from: they are drawn, none is run.
command -v gnuplot > /dev/null || { echo "no gnuplot"; exit 77; }
command -v python3 > /dev/null || { echo "no Python"; exit 77; }
python3 "$SRC/tests/hostile_strings.py" 1000 1
