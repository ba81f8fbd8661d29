# A format is added by one file and one row of the list: then every tool reads a signal in it, and each
# that writes signals, coefficients or rows writes it.  It has a line FISH, then its rate, names and
# numbers with a bar between.
mkdir -p src/io bin
sed 's/^    row(npy)$/    row(npy) \\\n    row(fish)/' "$SRC/src/io/format.h" > src/io/format.h
diff "$SRC/src/io/format.h" src/io/format.h | grep -c '^> ' || true
cat > src/io/fish.c <<'C'
#include <string.h>
#include "io/format.h"

struct fish {
    ss_source base;
    struct input *in;
};

static ss_status
give_fish(ss_source *s, double *const column[], size_t max, size_t *n, ss_error *err)
{
    struct input *in = ((struct fish *)s)->in;
    char *line;
    size_t length;
    for (; *n < max; ++*n) {
        ss_status st = ss_input_line(in, &line, &length, err);
        if (st != SS_OK || line == NULL)
            return st;
        for (size_t c = 0; c < s->head->n_columns; c++) {
            char *end;
            double x = ss_number_parse(line, &end);
            if (column[c] != NULL)
                column[c][*n] = x;
            line = end + (*end == '|');
        }
    }
    return SS_OK;
}

static ss_status
open_fish(ss_source **out, const struct opening *o, ss_error *err)
{
    static const struct source_calls calls = { .next = give_fish };
    struct fish *f = ss_source_new(sizeof *f, &calls, o->in->name, err);
    char *line, *end;
    size_t length;
    if (f == NULL)
        return SS_ENOMEM;
    *out = &f->base;
    f->in = o->in;
    ss_status st = ss_input_line(o->in, &line, &length, err);
    if (st == SS_OK)
        st = ss_input_line(o->in, &line, &length, err);
    if (st != SS_OK || line == NULL)
        return st;
    f->base.head->rate = ss_number_parse(line, &end);
    for (char *name = strtok(end, "|"); name != NULL; name = strtok(NULL, "|"))
        ss_header_add_column(f->base.head, name, NULL, err);
    return SS_OK;
}

static ss_status
begin_fish(FILE *out, const ss_header *head, const char *magic, ss_error *err)
{
    char rate[SS_NUMBER_MAX];
    (void)magic, (void)err;
    ss_number_format(rate, head->rate);
    fprintf(out, "FISH\n%s", rate);
    for (size_t c = 0; c < head->n_columns; c++)
        fprintf(out, "|%s", head->column[c].name);
    fputc('\n', out);
    return SS_OK;
}

static size_t
format_fish(char *to, double x, int last)
{
    size_t n = ss_number_format(to, x);
    to[n] = last ? '\n' : '|';
    return n + 1;
}

FORMAT(fish) = {
    .name = "fish", .magic = "FISH", .open = open_fish,
    .begin = begin_fish, .number = format_fish, .separator = '|'
};
C
# The file alone, without the row, does not compile.
# shellcheck disable=SC2086  # flags are a list
! $CC -std=c11 -D_XOPEN_SOURCE=700 -I"$SRC/include" -I"$SRC/src" $INCLUDES -c src/io/fish.c 2> log || echo "compiled"
grep -o 'FORMAT_fish.* undeclared\|undeclared.*FORMAT_fish' log | head -n 1 | tr -d "'‘’" || cat log
for file in "$SRC"/src/io/*.c src/io/fish.c; do
    # shellcheck disable=SC2086  # flags are a list
    $CC -std=c11 -D_XOPEN_SOURCE=700 -Isrc -I"$SRC/include" -I"$SRC/src" $INCLUDES -c "$file"
done
# shellcheck disable=SC2086  # a list
parts=$(printf "$BUILD/tools/%s.o " $TOOL_PARTS)
for tool in cat features morlet plot noise filter rank trade sim signal sweep; do
    # shellcheck disable=SC2086
    $CCLD -o "bin/ss-$tool" "$BUILD/tools/ss-$tool.o" $parts ./*.o "$BUILD/libstickslip.a" $LIBS
done
PATH=$PWD/bin:$PATH

echo '-- what writes signals'
ss-signal ringdown --duration 4 --rate 500 --frequency 20 -o ring.fish
ss-signal ringdown --duration 4 --rate 500 --frequency 20 > ring.tsv
head -n 3 ring.fish
ss-cat ring.fish --format fish | cmp - ring.fish
ss-sim -s duration=0.01 coulomb --format fish | head -n 2
echo '-- what reads them: the same as of text'
for command in ss-cat 'ss-noise --rms 1' ss-morlet ss-plot 'ss-features -q' 'ss-rank -q --long'; do
    $command ring.tsv | grep -v -e '^# signal' > one
    $command ring.fish | grep -v -e '^# signal' > two
    cmp one two && [ "$(wc -l < two)" -gt 9 ] && echo "$command: the same"
done
ss-trade -q -b 0.01 ring.fish | grep '^# compared'
echo '-- what writes rows'
ss-morlet --voices 1 --format fish ring.fish | head -n 2 | tail -n 1
ss-features ring.fish -o features.fish && head -n 1 features.fish | cut -d '|' -f 1-12
ss-sim --events -s settle=0 -s duration=0.5 coulomb -o events.fish && head -n 2 events.fish
ss-rank -q ring.fish coulomb -o ranking.fish && head -n 1 ranking.fish | cut -d '|' -f 1-5
ss-sweep coulomb --vary friction=0.5:1:2 --measure stops -o sweep.fish && cat sweep.fish
