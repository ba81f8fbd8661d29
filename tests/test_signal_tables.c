/* test_signal_tables.c -- delimited text as recorders write it, and the clock behind its stamps. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <unistd.h>
#include "signal/gaps.h"
#include "signal/source.h"
#include "signal_text.h"
#include "read_opts.h"
#include "signal/noise.h"

/* Headers of LabVIEW's measurement files, with two channels. */
#define LVM(x_columns) "LabVIEW Measurement\t\nWriter_Version\t2\nSeparator\tTab\nMulti_Headings\tNo\n" \
    "X_Columns\t" x_columns "\nTime_Pref\tAbsolute\nDate\t2020/03/05\nTime\t10:12:13.5\n***End_of_Header***\t\n\t\n"
#define SEGMENT_OF(step, start) "Channels\t2\t\t\nSamples\t2\t2\t\nDate\t2020/03/05\t2020/03/05\t\n" \
    "Time\t10:12:13.5\t10:12:13.5\t\nY_Unit_Label\tN\tm/s^2\t\nX_Dimension\tTime\tTime\t\n" \
    "X0\t" start "\t" start "\t\nDelta_X\t" step "\t" step "\t\n***End_of_Header***\t\t\t\n"
#define SEGMENT SEGMENT_OF("0.0005", "0.25")

static const struct table_case {
    const char *what, *text;
    const char *time;
    double rate;                                /* of the options */
    const char *names;                          /* name[unit], ... */
    double hz, start, last;                     /* last: of the last column and row */
} table[] = {
    { "comma", "t,x,y\n0,1,2\n0.1,3,4\n", NULL, 0, "x[] y[]", 10, 0, 4 },
    { "semicolon, decimal comma, CRLF, mark, units row", "\xef\xbb\xbfZeit;Kraft;Weg\r\ns;kN;mm\r\n"
      "0,00;1,5;2\r\n0,01;-2,5E-3;7,25\r\n", NULL, 0, "Kraft[kN] Weg[mm]", 100, 0, 7.25 },
    { "tab, decimal comma", "t\tx\n0,5\t1,5\n0,75\t2,5\n", NULL, 0, "x[]", 4, 0.5, 2.5 },
    { "tab, decimal point", "Time (s)\tx (m/s^2)\n0\t1\n0.5\t2", NULL, 0, "x[m/s^2]", 2, 0, 2 },
    { "blanks", "  t   x\n  0   1 \n  1   2 \n", NULL, 0, "x[]", 1, 0, 2 },
    { "commented names", "# t x\n0 1\n1 2\n", NULL, 0, "x[]", 1, 0, 2 },
    { "units in brackets", "t [ms],x [m/s],y/N,z/(N s)\n0,1,2,3\n2,1,2,5\n", NULL, 0,
      "x[m/s] y[N] z[N s]", 500, 0, 5 },
    { "units row in brackets", "t,x\n[ms],[m/s]\n1,2\n3,4\n", NULL, 0, "x[m/s]", 500, 0.001, 4 },
    { "units row with an empty cell", "t,mu,a\ns,,m/s\xc2\xb2\n1,2,3\n3,4,5\n", NULL, 0,
      "mu[] a[m/s\xc2\xb2]", 0.5, 1, 5 },
    { "words above", "Recorder;ACME\nRate;100\n\nA long line of words\nt;x\n0;1\n0,01;2\n", NULL, 0, "x[]", 100,
      0, 2 },
    { "quotes", "\"t\",\"force, \"\"raw\"\" (N)\"\n\"0\",\"1\"\n1,2\n", NULL, 0, "force,_\"raw\"[N]",
      1, 0, 2 },
    { "separators at the ends of lines", "t,x,\n0,1,\n1,2,\n", NULL, 0, "x[]", 1, 0, 2 },
    { "time is not the first", "x,Time (us)\n7,0\n8,10\n", NULL, 0, "x[]", 100000, 0, 8 },
    { "time by name", "x,t,clock\n7,0,3\n8,1,5\n", "clock", 0, "x[] t[]", 0.5, 3, 1 },
    { "time by number", "x,t,clock\n7,0,3\n8,1,5\n", "3", 0, "x[] t[]", 0.5, 3, 1 },
    { "time in its name", "time_ms,x\n0,1\n1,2\n", NULL, 0, "x[]", 1000, 0, 2 },
    { "time in minutes", "t [min],x\n0,1\n1,2\n", NULL, 0, "x[]", 1. / 60, 0, 2 },
    { "first column in seconds", "when (s),x\n0.25,1\n0.5,2\n0.75,3\n", NULL, 0, "x[]", 4, 0.25, 3 },
    { "no names", "0,1\n0.1,2\n", NULL, 0, "ch2[]", 10, 0, 2 },
    { "a rate given", "x,y\n5,1\n3,2\n4,9\n", NULL, 250, "x[] y[]", 250, 0, 9 },
    { "a rate given beats stamps", "t,y\n5,1\n3,2\n4,9\n", NULL, 250, "t[] y[]", 250, 0, 9 },
    { "one column", "Force (N)\n1.5\n\n2.5\n", NULL, 10, "Force[N]", 10, 0, 2.5 },
    { "comments and empty lines between", "t,x\n0,1\n# hello\n\n1,2\n", NULL, 0, "x[]", 1, 0, 2 },
    { "LabVIEW", "LabVIEW Measurement\nSeparator\tTab\nMulti_Headings\tNo\n***End_of_Header***\t\n\t\n"
      "Channels\t2\t\t\nY_Unit_Label\tNewton\tm/s^2\t\nX_Dimension\tTime\tTime\t\n"
      "X0\t0.0E+0\t0.0E+0\t\nDelta_X\t0.001\t0.001\t\n***End_of_Header***\t\t\t\n"
      "X_Value\tforce\taccel\tComment\r\n0.000\t1.5\t2.5\r\n0.001\t1.25\t2.25\r\n", NULL, 0,
      "force[Newton] accel[m/s^2]", 1000, 0, 2.25 },
    { "LabVIEW without a column of x", LVM("No") SEGMENT "X_Value\tforce\taccel\tComment\n"
      "\t1.5\t2.5\tbegin\n\t1.25\t2.25\t\n", NULL, 0, "force[N] accel[m/s^2]", 2000, 0.25, 2.25 },
    { "LabVIEW without names", LVM("One") SEGMENT "0.25\t1.5\t2.5\tbegin\n0.2505\t1.25\t2.25\t\n", NULL, 0,
      "ch2[N] ch3[m/s^2]", 2000, 0.25, 2.25 },
    { "LabVIEW with a column of x each", LVM("Multi") SEGMENT "X_Value\tforce\tX_Value\taccel\tComment\n"
      "0.25\t1.5\t0.25\t2.5\n0.2505\t1.25\t0.2505\t2.25\n", NULL, 0, "force[N] accel[m/s^2]", 2000, 0.25, 2.25 },
    { "LabVIEW with times of too few digits", LVM("One") SEGMENT_OF("0.0000002", "0") "X_Value\ta\tb\tComment\n"
      "0.000000\t1.5\t2.5\n0.000000\t1.25\t2.25\n0.000000\t1\t2\n0.000001\t7\t8\n", NULL, 0, "a[N] b[m/s^2]",
      5000000, 0, 8 },
    { "LabVIEW with decimal commas", LVM("No") SEGMENT_OF("0,0005", "0,25") "X_Value\tforce\taccel\tComment\n"
      "\t1,5\t2,5\n\t1,25\t2,25\n", NULL, 0, "force[N] accel[m/s^2]", 2000, 0.25, 2.25 },
    { "headers of National Instruments", "Channel name\tforce\taccel\nUnit\tN\tg\nInterval\t0.001\t0.001\n"
      "1.5\t2.5\n1.25\t2.25\n", NULL, 0, "force[N] accel[g]", 1000, 0, 2.25 },
    { "the same with numbered rows", "Channel name,force,accel\nUnit,N,g\nInterval,0.001,0.001\n"
      "1,1.5,2.5\n2,1.25,2.25\n", NULL, 0, "force[N] accel[g]", 1000, 0, 2.25 },
    { "the same with times", "Channel name,force,accel\nUnit,N,g\nInterval,0.001,0.001\n"
      "0.5,1.5,2.5\n0.501,1.25,2.25\n", NULL, 0, "force[N] accel[g]", 1000, 0.5, 2.25 },
    { "Fortran", "  t   x\n 0.0D+00  1.5D-03\n 1.0d-01  2.5D-03\n", NULL, 0, "x[]", 10, 0, 2.5e-3 },
    { "milliseconds as a name", "ms,x\n0,1\n0.5,2\n", NULL, 0, "x[]", 2000, 0, 2 },
    { "milliseconds as a name that is chosen", "x,ms\n1,0\n2,0.5\n", "ms", 0, "x[]", 2000, 0, 2 },
    { "milliseconds in a name that is chosen", "x,Sampled_ms\n1,0\n2,0.5\n", "Sampled_ms", 0, "x[]", 2000, 0, 2 },
    { "milliseconds since 1970", "timestamp,x\n1709633533125,1\n1709633533126,2\n", NULL, 0, "x[]", 1000,
      1709633533.125, 2 },
    { "nanoseconds since 1970", "timestamp,x\n1709633533125000000,1\n1709633533126000000,2\n", NULL, 0, "x[]",
      1000, 1709633533.125, 2 },
    { "dates", "when,x\n2024-03-05T10:12:13.125Z,1\n2024-03-05T10:12:13.250Z,2\n", NULL, 0, "x[]", 8,
      36733.125, 2 },
    { "dates with zones and commas", "when;x\n2024-03-05 23:59:59,75+01:00;1\n2024-03-06 00:00:00,00+0100;2\n", NULL,
      0, "x[]", 4, 82799.75, 2 },
    { "dates with points over midnight", "Datum;x\n31.12.2023 23:59:59,5;1\n1.1.2024 0:00:00,0;2\n", NULL, 0, "x[]", 2,
      86399.5, 2 },
    { "days before months over midnight", "when,x\n03/05/2024 23:59:59.5,1\n04/05/2024 00:00:00.0,2\n", NULL, 0, "x[]",
      2, 86399.5, 2 },
    { "months before days over midnight", "when,x\n03/05/2024 11:59:59.5 PM,1\n03/06/2024 12:00:00.0 am,2\n", NULL, 0,
      "x[]", 2, 86399.5, 2 },
    { "a day above 12 behind the month", "when,x\n02-28-2024 23:59:59.5,1\n02-29-2024 00:00:00.0,2\n", NULL, 0, "x[]",
      2, 86399.5, 2 },
    { "units behind quoted names", "\"t\" [s],\"x\" (N)\n\"0\",\"1\" \n\"0.5\",2\n", NULL, 0, "x[N]", 2, 0, 2 },
    { "words below the rows", "t,x\n0,1\n0.5,2\n\nEnd of data\n", NULL, 0, "x[]", 2, 0, 2 },
    { "12 o'clock", "Time,x\n11:59:59.5 AM,1\n12:00:00.0 PM,2\n12:00:00.5PM,3\n", NULL, 0, "x[]", 2, 43199.5, 3 },
    { "times of day over midnight", "Date,Time,x\n2024/02/28,23:59:59.5,1\n2024/02/29,00:00:00.0,2\n"
      "2024/02/29,00:00:00.5,3\n", NULL, 0, "x[]", 2, 86399.5, 3 },
    { "times of day between blanks", "10:12:13.125 1\n10:12:13.250 2\n", NULL, 0, "ch2[]", 8, 36733.125, 2 },
    { "a column of words", "t,x,label\n0,1,ok\n0.5,2,ok\n1,3,\n", NULL, 0, "x[]", 2, 0, 3 },
    { "words first", "label;t;x\nok;0;1,5\nlate;0,5;2,5\nok;1;3\n", NULL, 0, "x[]", 2, 0, 3 },
    { "a row of units above words", "t,x,state\ns,mm,\n0,1,up\n0.5,2,up\n1,3,down\n", NULL, 0, "x[mm]", 2, 0, 3 },
    { "LabVIEW with a row of units", "X_Value\tforce\taccel\tcomment\ns\tN\tm/s^2\tComment\n0\t1\t2\n"
      "0.5\t3\t4\n", NULL, 0, "force[N] accel[m/s^2]", 2, 0, 4 },
    { "one empty name more", "t;x;\ns;mm;\n0;1\n0,5;2\n", NULL, 0, "x[mm]", 2, 0, 2 },
    { "Latin-1", "t/s;Weg/\xb5m;K\xfc" "bel (m/s\xb2)\n0;1;2\n1;2;3\n", NULL, 0,
      "Weg[\xc2\xb5m] K\xc3\xbc" "bel[m/s\xc2\xb2]", 1, 0, 3 },
    { "Latin-1 units row", "Zeit;Weg;\xe9t\xe9\ns;\xb5m;m/s\xb2\n0;1;2\n1;2;3\n", NULL, 0,
      "Weg[\xc2\xb5m] \xc3\xa9t\xc3\xa9[m/s\xc2\xb2]", 1, 0, 3 },
    { "UTF-8 of two to four bytes", "t,\xc2\xb5\xe2\x82\xac\xf0\x9f\x98\x80\n0,1\n1,2\n", NULL, 0,
      "\xc2\xb5\xe2\x82\xac\xf0\x9f\x98\x80[]", 1, 0, 2 },
    { "nearly UTF-8", "t,\xc0\xaf\xed\xa0\x80\n0,1\n1,2\n", NULL, 0,
      "\xc3\x80\xc2\xaf\xc3\xad\xc2\xa0__[]", 1, 0, 2 },
    { "a row of units with an unknown one, below the time", "Time;Force;Torque\ns;N;furlong\n0;1;2\n.01;2;3\n", NULL, 0,
      "Force[N] Torque[furlong]", 100, 0, 3 },
    { "a row of units in capitals (MTS)", "Time\tAxial Displacement\tAxial Force\nSec\tmm\tkN\n0\t1\t2\n0.5\t2\t3\n", NULL,
      0, "Axial_Displacement[mm] Axial_Force[kN]", 2, 0, 3 },
    { "a row of units in words (Keysight)", "x-axis,C1,C2\nsecond,Volt,arb\n0,1,2\n0.5,2,3\n", NULL, 0,
      "C1[Volt] C2[arb]", 2, 0, 3 },
    { "names below a title of as many words", "run,of,today\nt,s,mu\n0,1,2\n0.5,2,3\n", NULL, 0, "s[] mu[]", 2, 0, 3 },
    { "settings beside the first rows (Tektronix)", "Record Length,5,,-0.5,1,\nSample Interval,0.25,,-0.25,2,\n"
      "Trigger Point,1,,0,3,\n,,,0.25,4,\nSource,CH1,,0.5,5,\n,,,0.75,6,\n", NULL, 0, "ch5[]", 4, -0.5, 6 },
    { "names of months", "when,x\n31-Dec-2023 23:59:59.5,1\n1-jan-2024 00:00:00.0,2\n", NULL, 0, "x[]", 2, 86399.5, 2 },
    { "units behind commas and in", "Time, ms;Kraft, kN;Weg in mm;Run, 2;velocity_in_s\n0;1;2;3;4\n2;2;3;4;5\n", NULL, 0,
      "Kraft[kN] Weg[mm] Run,_2[] velocity_in_s[in/s]", 500, 0, 5 },
    { "a name behind a comment's mark", "%Time,x\n0,1\n0.5,2\n", NULL, 0, "x[]", 2, 0, 2 },
    { "the same name twice", "t,x,x\n0,1,2\n1,2,3\n", NULL, 0, "x[] x_2[]", 1, 0, 3 },
};

static void
reads_tables_as_recorders_write_them(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        const struct table_case *c = &table[i];
        ss_read_opts opts = { READ_OPTS, .time = c->time, .rate = c->rate };
        ss_signal *s = read_text(c->text, &opts);
        char names[512] = "";
        for (size_t k = 0; k < s->head->n_columns; k++)
            snprintf(names + strlen(names), sizeof names - strlen(names), "%s%s[%s]", k > 0 ? " " : "",
                     s->head->column[k].name, s->head->column[k].unit);
        if (strcmp(names, c->names) != 0)
            fail_msg("%s: columns %s, not %s", c->what, names, c->names);
        if (s->head->rate != c->hz || s->head->start != c->start)
            fail_msg("%s: %.17g Hz from %.17g s", c->what, s->head->rate, s->head->start);
        if (s->values[s->head->n_columns * s->n - 1] != c->last)
            fail_msg("%s: last value %.17g", c->what, s->values[s->head->n_columns * s->n - 1]);
        ss_signal_free(s);
    }
}

/* Stamps start + i / rate in the given printf format, each moved by a wobble in sample periods. */
static ss_status
read_stamps(double *hz, double rate, double start, size_t n, const char *format, double wobble)
{
    FILE *f = tmpfile();
    ss_signal *s;
    ss_error err;
    fputs("t,x\n", f);
    for (size_t i = 0; i < n; i++) {
        fprintf(f, format, start + ((double)i + (i % 2 ? wobble : -wobble)) / rate);
        fputs(",0\n", f);
    }
    rewind(f);
    ss_status st = ss_signal_read(&s, f, "in", NULL, &err);
    fclose(f);
    if (st == SS_OK) {
        *hz = s->head->rate;
        ss_signal_free(s);
    }
    return st;
}

/* The last warning. */
static void
keep_warning(ss_status about, const char *text, void *user)
{
    (void)about;
    snprintf(user, sizeof ((ss_error *)NULL)->text, "%s", text);
}

static void
warns_of_what_is_guessed_or_left_out(void **state)
{
    static const struct { const char *text, *warning; } row[] = {
        { "t (s),x\n0,1\n1,2\n", "" },
        { "t,x\n0,1\n0.001,2\n", "" },
        { "t,x\n0,1\n1,2\n", "in: column t has no unit and is read in seconds: 1 Hz" },
        { "timestamp,x\n1709633533125,1\n1709633533126,2\n",
          "in: column timestamp has no unit and is read in ms since 1970" },
        { "t_s,x,label\n0,1,ok\n0.5,2,ok\n", "in:2: column 3 (\"label\") holds text; it was skipped" },
        { "# a log\n# of Monday\nt_s,x,label\n0,1,ok\n0.5,2,late\n",
          "in:4: column 3 (\"label\") holds text; it was skipped" },
    };
    (void)state;
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        ss_error warning = { 0 };
        ss_read_opts opts = { READ_OPTS, .warn = keep_warning, .user = warning.text };
        ss_signal_free(read_text(row[i].text, &opts));
        assert_string_equal(warning.text, row[i].warning);
    }
}

static void
refuses_what_it_cannot_know(void **state)
{
    static const struct { const char *text, *time_unit; size_t table; ss_status status; const char *words; } row[] = {
        { "ms,x\n0,1\n1e9,2\n", NULL, 0, SS_EUNIT, "read in ms, gives a clock of 1e-06 Hz, which no laboratory" },
        { "t,x\n0,1\n1e-11,2\n", NULL, 0, SS_EUNIT, "read in s, gives a clock of 1e+11 Hz" },
        { "t,x\n0,1\n1e-11,2\n", "s", 0, SS_OK, "" },
        { "t,x\n0,1\n1,2\n", "mm", 0, SS_EDATA, "unit 'mm' is not one of time" },
        { "t,x\n0,1\n1,2\n2,bad\n3,4\n", NULL, 0, SS_EDATA, "in:4: column x: 'bad' is not a number" },
        { "t,x\n10:12:13,1\n10:12:14,2\nnoon,3\n", NULL, 0, SS_EDATA, "in:4" },
        { "when,x\n2024-02-29 00:00:00,1\n2024-03-01 00:00:00,2\n", NULL, 0, SS_OK, "" },
        { "when,x\n2023-02-28 00:00:00,1\n2023-02-29 00:00:00,2\n", NULL, 0, SS_EDATA, "in:3: column when" },
        { "when,x\n1900-02-29 00:00:00,1\n1900-03-01 00:00:00,2\n", NULL, 0, SS_EDATA, "in:2: column 1" },
        { "Abtastrate;25600 Hz\nKanal;Kraft\nF;x\n1;2\n2;3\n", NULL, 0, SS_ECLOCK,
          "but line 1 may give the rate: 'Abtastrate;25600 Hz'" },
        { "Flow rate,3\nSamples,2\nSampling: 25.6 kHz\nF,x\n1,2\n2,3\n", NULL, 0, SS_ECLOCK, "but line 3 may give" },
        { "Pirate 3\nSample rate: 25.6 kHz\nF,x\n1,2\n2,3\n", NULL, 0, SS_ECLOCK, "but line 2 may give" },
        { "# dt = 1e-4 s\nF,x\n1,2\n2,3\n", NULL, 0, SS_ECLOCK, "but line 1 may give the rate: 'dt = 1e-4 s'" },
        { "Fr\351quence d'\351chantillonnage;100\nF;x\n1;2\n2;3\n", NULL, 0, SS_ECLOCK, "but line 1 may give" },
        { "operated by 3\nF,offset\n1,2\n2,3\n", NULL, 0, SS_ECLOCK, "in: no column of time" },
        { "when,x\n2024-03-05T10:12:13+24:00,1\n2024-03-05T10:12:14+24:00,2\n", NULL, 0, SS_ECLOCK, "no column of time" },
        { "when,x\n2024-03-05T10:12:13Z,1\n2024-03-05T10:12:14+00:60,2\n", NULL, 0, SS_EDATA, "in:3: column when" },
        { "when,x\n30.4.2024 0:00:00,1\n31.4.2024 0:00:00,2\n", NULL, 0, SS_EDATA, "in:3: column when" },
        { "t,x\n10:12:13,1\n10:12:12,2\n", NULL, 0, SS_ECLOCK, "do not ascend" },
        { "t,x\n10:12:13,1\n10:12:14,2\n", "ms", 0, SS_EDATA, "has no unit to choose" },
        { "t_s,x\n0,1\n1,2\nStep 2\nt_s,y\n0,3\n1,4\n", NULL, 0, SS_ETABLES,
          "in: 2 tables: 1 from line 2, 2 rows of t_s x; 2 from line 6, 2 rows of t_s y" },
        { "t_s,x\n0,1\n1,2\nStep 2\nt_s,y\n0,3\n1,4\n", NULL, 3, SS_ETABLES, "in: 2 tables" },
        { "t_s,x\n0,1\n1,2\n", NULL, 2, SS_ETABLES, "in: 1 table: 1 from line 2" },
        { "t_s,x\n0,1\n1,2\nEnd,of data\n", NULL, 0, SS_EDATA, "in:4: column t_s: 'End' is not a number" },
        { LVM("Multi") SEGMENT "X_Value\ta\tX_Value\tb\tComment\n0\t1\t0.1\t2\n0.0005\t1\t0.1005\t2\n", NULL,
          0, SS_EDATA, "in: column 3: the times of its channel are not those of the first" },
    };
    (void)state;
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        ss_read_opts opts = { READ_OPTS, .time_unit = row[i].time_unit, .table = row[i].table };
        ss_signal *s = NULL;
        ss_error err = { 0 };
        ss_status st = read_bytes(&s, row[i].text, strlen(row[i].text), &opts, &err);
        if (st != row[i].status || strstr(err.text, row[i].words) == NULL)
            fail_msg("%s: %d: %s", row[i].text, st, err.text);
        if (st == SS_OK)
            ss_signal_free(s);
    }
}

static void
reads_one_of_several_tables(void **state)
{
    const char *text = LVM("No") SEGMENT "X_Value\ta\tb\tComment\n\t1\t2\t\n\t3\t4\n\n\n" SEGMENT
        "X_Value\tc\td\tComment\n\t5\t6\n\t7\t8\n\t9\t10\n";
    const char *steps = "Test 7\nStep 1\nt,Fx,Fz\nsec,N,N\n0,1,2\n0.01,3,4\n\nStep 2\nt,Fz\nsec,N\n0.02,5\n0.03,6\n";
    (void)state;
    for (size_t number = 1; number <= 2; number++) {
        ss_read_opts opts = { READ_OPTS, .table = number };
        ss_signal *s = read_text(text, &opts);
        assert_string_equal(s->head->column[0].name, number == 1 ? "a" : "c");
        assert_int_equal(s->n, number == 1 ? 2 : 3);
        assert_true(s->head->rate == 2000);
        ss_signal_free(s);
        s = read_text(steps, &opts);
        assert_int_equal(s->head->n_columns, number == 1 ? 2 : 1);
        assert_true(s->head->rate == 100 && s->head->start == (number == 1 ? 0 : 0.02));
        ss_signal_free(s);
    }
}

static void
calibrates_and_cuts(void **state)
{
    const char *text = "t_s,f (V),x (mm)\n0,1,2\n0.5,3,4\n1,5,6\n1.5,7,8\n";
    const ss_calibration of[] = { { "f", 250, NULL }, { "x", 0, "um" }, { "1", 0, "N" }, { "x", 1e3, NULL } };
    ss_read_opts opts = { READ_OPTS, .from = 0.5, .to = 1.5, .calibration = of, .n_calibrations = 4 };
    ss_signal *s = read_text(text, &opts);
    ss_error err = { 0 };
    (void)state;
    assert_int_equal(s->n, 2);
    assert_true(s->head->start == 0.5 && s->values[0] == 750 && s->values[1] == 1250 && s->values[3] == 6000);
    assert_string_equal(s->head->column[0].unit, "N");
    assert_string_equal(s->head->column[1].unit, "um");
    assert_string_equal(ss_header_find_note(s->head, "calibration"), "f x 250 N, x x 1000 um");
    ss_signal_free(s);
    opts.from = 7, opts.to = 8;
    assert_int_equal(read_bytes(&s, text, strlen(text), &opts, &err), SS_EDATA);
    assert_non_null(strstr(err.text, "no samples from 7 to 8 s"));
    const ss_calibration unnamed = { NULL, 2, NULL };
    opts = (ss_read_opts){ READ_OPTS, .calibration = &unnamed, .n_calibrations = 1 };
    assert_int_equal(read_bytes(&s, text, strlen(text), &opts, &err), SS_EINVAL);
}

static void
finds_the_exact_rate_behind_rounded_stamps(void **state)
{
    static const struct { double rate, start; size_t n; const char *format; } row[] = {
        { 1024, 0, 10241, "%.7g" }, { 1024, 0, 10241, "%.17g" }, { 50000, 91.181303, 10000, "%.6f" },
        { 2000, 94, 120000, "%.4f" }, { 44100, 0, 50000, "%.6f" }, { 1 / 0.003, 0, 3000, "%.4f" },
        { 1 / 0.007, 1e6, 3000, "%.3f" }, { 3, 0, 1000, "%.3f" }, { 1e6, 0, 1000, "%.9f" },
        { 0.001, 0, 100, "%g" }, { 25600, 0, 25600, "%.17g" }, { 1 / 60., 0, 50, "%.1f" },
    };
    (void)state;
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        double hz = 0;
        assert_int_equal(read_stamps(&hz, row[i].rate, row[i].start, row[i].n, row[i].format, 0), SS_OK);
        if (hz != row[i].rate)
            fail_msg("%.17g Hz in %s: %.17g Hz", row[i].rate, row[i].format, hz);
    }
}

static void
allows_stamps_a_tenth_of_a_period_off(void **state)
{
    double hz;
    (void)state;
    assert_int_equal(read_stamps(&hz, 100, 0, 1000, "%.17g", 0.099), SS_OK);
    assert_true(fabs(hz - 100) <= 100 * 2 * 0.1 / 999);        /* what the wobble leaves open */
    assert_int_equal(read_stamps(&hz, 100, 0, 1000, "%.17g", 0.101), SS_EUNEVEN);
}

static void
refuses_options_that_a_clock_excludes(void **state)
{
    ss_signal *s;
    ss_error err = { 0 };
    const char *text = HEAD "0\t1\t2\n";
    (void)state;
    ss_read_opts rate = { READ_OPTS, .rate = 20 }, time = { READ_OPTS, .time = "x" },
        same = { READ_OPTS, .rate = 10 };
    assert_int_equal(read_bytes(&s, text, strlen(text), &rate, &err), SS_EDATA);
    assert_int_equal(read_bytes(&s, text, strlen(text), &time, &err), SS_EDATA);
    ss_signal_free(read_text(text, &same));
    ss_signal_free(read_text("# stickslip signal 1\n# columns: x\n1\n", &same));
}

/* Copied from the README beside the recordings. */
static void
reads_the_measured_recordings(void **state)
{
    static const struct { const char *name; double rate, start; size_t n, columns; } row[] = {
        { "band_friction_damper_1hz_20lb.csv", 1024, 0, 10241, 3 },
        { "paper_friction_k168_v42.csv", 2000, 94, 120000, 1 },
        { "paper_friction_k168_v4300.csv", 2000, 0.9395, 7521, 1 },
        { "rock_labquake_fb03-087_event043.csv", 50000, 91.181303, 10000, 2 },
    };
    (void)state;
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        char path[128];
        ss_signal *s;
        ss_error err = { 0 };
        snprintf(path, sizeof path, "../shared/data/measured/%s", row[i].name);
        FILE *f = fopen(path, "r");
        if (f == NULL) {
            print_message("skipped: no ../shared/data/measured\n");
            skip();
        }
        if (ss_signal_read(&s, f, path, NULL, &err) != SS_OK)
            fail_msg("%s", err.text);
        assert_true(s->head->rate == row[i].rate && s->head->start == row[i].start);
        assert_true(s->n == row[i].n && s->head->n_columns == row[i].columns);
        ss_signal_free(s);
        fclose(f);
    }
}

static void
interpolates_uneven_stamps_to_a_uniform_clock(void **state)
{
    (void)state;
    /* Stamps i + 0.4 sin(i) periods; natural ends spoil a few steps there (by a factor 0.27 a step).
     * Error of a cubic spline: 5/384 h^4 of x's fourth derivative, for the widest step, here of under 1.8 periods. */
    enum { N = 2000 };
    const double rate = 1000, w = 2 * M_PI * 20, h = 1.8 / rate, bound = 5. / 384 * pow(h * w, 4);
    const ss_read_opts opts = { READ_OPTS, .resample = 800 };
    FILE *f = tmpfile();
    ss_signal *s;
    fputs("t,x\n", f);
    for (int i = 0; i < N; i++) {
        double t = (i + 0.4 * sin(i)) / rate;
        fprintf(f, "%.17g,%.17g\n", t, sin(w * t));
    }
    rewind(f);
    assert_int_equal(ss_signal_read(&s, f, "in", &opts, NULL), SS_OK);
    fclose(f);
    assert_true(s->head->rate == 800 && s->head->start == 0);
    assert_int_equal(s->n, 1600);
    for (size_t i = 20; i < s->n - 20; i++)
        if (!(fabs(s->values[i] - sin(w * (double)i / 800)) <= bound))
            fail_msg("sample %zu is off by %g", i, s->values[i] - sin(w * (double)i / 800));
    assert_null(ss_header_find_note(s->head, "gaps"));
    ss_signal_free(s);
}

static ss_status
read_once(ss_signal **out, const char *text, const ss_read_opts *opts, ss_error *err)
{
    FILE *f = fmemopen((char *)text, strlen(text), "r");
    assert_non_null(f);
    ss_status st = ss_signal_read(out, f, "in", opts, err);
    fclose(f);
    return st;
}

/* Half the second derivatives of the natural cubic spline through n points, by elimination. */
static long double *
spline_of(const double *t, const double *x, size_t n)
{
    long double *c = calloc(n, sizeof *c), *d = calloc(n, sizeof *d);
    assert_true(c != NULL && d != NULL);
    for (size_t i = 1; i + 1 < n; i++) {
        long double left = (long double)t[i] - t[i - 1], right = (long double)t[i + 1] - t[i];
        long double slope = (x[i + 1] - x[i]) / right - ((long double)x[i] - x[i - 1]) / left;
        long double pivot = 2 * (left + right) - (i > 1 ? left * d[i - 1] : 0);
        d[i] = right / pivot;
        c[i] = (3 * slope - left * c[i - 1]) / pivot;
    }
    for (size_t i = n - 2; i > 0; i--)
        c[i] -= d[i] * c[i + 1];
    free(d);
    return c;
}

/* Noise at stamps whose steps differ by up to five to one, of more rows than are interpolated at a time: as exact
 * as one spline through all, at a higher and at a lower rate. */
static void
a_long_record_is_interpolated_as_by_one_spline(void **state)
{
    enum { N = 30000 };
    static const double rate[] = { 5000, 900, 13 };
    static double t[N], x[N];
    char *text = malloc(60 * N), *end = text + sprintf(text, "t_s,x\n");
    (void)state;
    assert_int_equal(ss_noise_add_once(x, N, 1, 3, NULL), SS_OK);
    for (size_t i = 0; i < N; i++) {
        t[i] = (double)i / 1000 + 0.0004 * sin((double)(i * i));
        end += sprintf(end, "%.17g,%.17g\n", t[i], x[i]);
    }
    long double *c = spline_of(t, x, N);
    for (size_t k = 0; k < sizeof rate / sizeof *rate; k++) {
        ss_signal *s = NULL;
        double worst = 0;
        assert_int_equal(read_once(&s, text, &(ss_read_opts){ READ_OPTS, .resample = rate[k] }, NULL), SS_OK);
        assert_int_equal(s->n, (size_t)floor((t[N - 1] - t[0]) * rate[k]) + 1);
        for (size_t i = 0, at = 0; i < s->n; i++) {
            double when = t[0] + (double)i / rate[k];
            for (; at + 2 < N && t[at + 1] <= when; at++)
                ;
            long double h = (long double)t[at + 1] - t[at], u = (long double)when - t[at];
            long double slope = ((long double)x[at + 1] - x[at]) / h - h * (2 * c[at] + c[at + 1]) / 3;
            long double want = x[at] + u * (slope + u * (c[at] + u * (c[at + 1] - c[at]) / (3 * h)));
            worst = fmax(worst, fabs((double)(s->values[i] - want)));
        }
        if (!(worst <= 64 * DBL_EPSILON * 4))   /* rounding of noise up to 4 */
            fail_msg("%g Hz: off by %g", rate[k], worst);
        ss_signal_free(s);
    }
    free(c);
    free(text);
}

/* --- the numbers of a long table are in another file ------------------------------------------------ */

enum { LONG = 100000 };         /* rows, of more numbers than memory holds */

static void
compare_readings(const char *text, const ss_read_opts *opts)
{
    ss_signal *a = NULL, *b = NULL;
    ss_error said_a = { 0 }, said_b = { 0 };
    ss_status st = read_bytes(&a, text, strlen(text), opts, &said_a);
    if (read_once(&b, text, opts, &said_b) != st || strcmp(said_a.text, said_b.text) != 0)
        fail_msg("%.200s: '%s' and '%s'", text, said_a.text, said_b.text);
    if (st != SS_OK)
        return;
    assert_int_equal(a->n, b->n);
    assert_int_equal(a->head->n_columns, b->head->n_columns);
    if (a->head->rate != b->head->rate || a->head->start != b->head->start)
        fail_msg("%.200s: %.17g and %.17g Hz", text, a->head->rate, b->head->rate);
    assert_memory_equal(a->values, b->values, a->n * a->head->n_columns * sizeof *a->values);
    ss_signal_free(a);
    ss_signal_free(b);
}

/* A long table: row i has the time i / 1000 and i, and the last row is the given text. */
static char *
long_table(size_t n, const char *last)
{
    char *text = malloc(24 * n + 100), *end = text + sprintf(text, "t_s,x\n");
    assert_non_null(text);
    for (size_t i = 0; i < n; i++)
        end += sprintf(end, "%.3f,%zu\n", (double)i / 1000, i);
    strcpy(end, last);
    return text;
}

static void
reads_a_file_as_it_reads_a_pipe(void **state)
{
    static const char *const text[] = {
        "t,x\n10:00:00,1\n22:00:00,2\n10:00:00,3\n22:00:00,4\n10:00:00,5\n",    /* days go on */
        "t;x\n0;1\n1;2\n2;1,5\n3;4\n", "t;x\n0;1.5\n1;2,5\n", "t;x\n0;1\n1;2,5\n2;1.5\n",
        "t,x\n0,1\n1,2\n2,1.0D+01\n3,1e999\n", "t,x\n0,1\n1,\n2,3\n", "t,x\n0,1\n1,nan\n2,3\n",
        "t,x\n0,1\n1,2\n3,4\n", "t,x\n0,1\n1,2\n1,4\n", "t,x\n0,1\n1,2\n3,4\n4,bad\n",
        "t,x\n0,1\n1,2\nStep 2\nt,y\n0,3\n1,4\n", "t,x\n0,1\n1,2\nEnd of data\n",
        "0,1\n1,2\n5,3\n", "t,x\n0,1\n# a comment\n\n1,2\n2, 3 \n 3,4\r\n", "t,x\n0,1\n1,2,3\n",
        "X,CH1,Start,Increment\nSequence,Volt,5,none\n0,1,,\n1,2,,\n2,3,,\n",    /* no increment: no start either */
        "t x\n0 1\n1  2\n2\t3\n", "x\n1\n2\n3\n", "t,x\n0,1\n", "date,x\n2024-03-05,1\n2024-03-06,2\n",
    };
    static const char *const last[] = { "", "100.000,1", "bad,1\n", "100.0005,1\n", "99.999,1\n",
        "100.3,1\n", "100,\n", "Step 2\nt,y\n0,1\n1,2\n" };
    static const ss_read_opts opts[] = { { READ_OPTS }, { READ_OPTS, .rate = 100 },
        { READ_OPTS, .gaps = SS_GAPS_INTERPOLATE }, { READ_OPTS, .table = 2 },
                                         { READ_OPTS, .from = 0.5, .to = 2.5 }, { READ_OPTS, .resample = 7 } };
    (void)state;
    for (size_t k = 0; k < sizeof opts / sizeof *opts; k++)
        for (size_t i = 0; i < sizeof text / sizeof *text; i++)
            compare_readings(text[i], &opts[k]);
    for (size_t i = 0; i < sizeof table / sizeof *table; i++)
        compare_readings(table[i].text, &(ss_read_opts){ READ_OPTS, .time = table[i].time, .rate = table[i].rate });
    for (size_t i = 0; i < sizeof last / sizeof *last; i++) {
        char *lines = long_table(LONG, last[i]);
        for (size_t k = 0; k < sizeof opts / sizeof *opts; k++)
            compare_readings(lines, &opts[k]);
        free(lines);
    }
}

/* A long table of x = 1000 t, of which every 700th row is missing, and every 1000th x. */
static char *
table_with_gaps(void)
{
    char *text = malloc(24 * LONG), *end = text + sprintf(text, "t_s,x,y\n");
    assert_non_null(text);
    for (size_t i = 0; i < LONG; i++)
        if (i % 700 != 699)
            end += sprintf(end, i % 1000 == 0 ? "%.3f,,7\n" : "%.3f,%zu,7\n", (double)i / 1000, i);
    return text;
}

static void
fills_the_gaps_of_a_long_table(void **state)
{
    static const ss_read_opts opts[] = { { READ_OPTS, .gaps = SS_GAPS_INTERPOLATE },
        { READ_OPTS, .gaps = SS_GAPS_SPLIT },
                                         { READ_OPTS, .gaps = SS_GAPS_INTERPOLATE, .resample = 2000 } };
    char *text = table_with_gaps();
    (void)state;
    for (size_t k = 0; k < 3; k++) {
        ss_signal *s = NULL;
        ss_error err = { 0 };
        ss_span *gap;
        size_t n_gaps, rows = k == 2 ? 2 * LONG - 1 : LONG, bad = 0;
        if (read_once(&s, text, &opts[k], &err) != SS_OK)
            fail_msg("%s", err.text);
        assert_int_equal(s->n, rows);
        for (size_t i = 0; i < rows; i++) {
            size_t row = k == 2 ? i / 2 : i;
            int lost = row % 700 == 699, gone = row % 1000 == 0;
            double x = k == 2 ? (double)i / 2 : (double)i;
            double want = k == 1 && (lost || gone) ? 0 : i < (k == 2 ? 2 : 1) ? 1 : x;
            bad += fabs(s->values[i] - want) > 1e-9;
            bad += fabs(s->values[rows + i] - (k == 1 && lost ? 0 : 7)) > 1e-12;
        }
        assert_int_equal(bad, 0);
        assert_int_equal(ss_header_gaps(&gap, &n_gaps, s->head, NULL), SS_OK);
        assert_int_equal(n_gaps, k == 2 ? LONG / 1000 : LONG / 1000 + LONG / 700 - LONG / 7000);
        free(gap);
        ss_signal_free(s);
    }
    free(text);
}

/* A recorder may append rows meanwhile, or begin anew: the rows that were there at first are given. */
static void
reads_a_file_as_it_was_at_first(void **state)
{
    enum { GROWS, SHRINKS, CHANGES };
    (void)state;
    for (int how = GROWS; how <= CHANGES; how++) {
        char *text = long_table(LONG, ""), *at = strstr(text, "8.000,");
        FILE *f = file_of(text, strlen(text));
        ss_reader *reader;
        double row[1000], *column = row;
        size_t n, all = 0;
        ss_status st = ss_reader_new(&reader, f, "in", NULL, NULL);
        assert_int_equal(st, SS_OK);
        if (how == GROWS)
            assert_true(pwrite(fileno(f), "100.000,1\n", 10, (off_t)strlen(text)) == 10);
        else if (how == SHRINKS)
            assert_int_equal(ftruncate(fileno(f), at - text), 0);
        else
            assert_true(pwrite(fileno(f), "8.000,8001", 10, at - text) == 10);
        while ((st = ss_reader_rows(reader, &column, 1000, &n, NULL)) == SS_OK && n > 0)
            for (size_t i = 0; i < n; i++)
                assert_true(row[i] == (double)all++);
        assert_int_equal(st, SS_OK);
        assert_int_equal(all, LONG);
        ss_reader_free(reader);
        fclose(f);
        free(text);
    }
}

enum { ROWS = 4 };

/* A source whose rows are others when they are read again. */
struct changing {
    ss_source base;
    const double *now, *again;
    int ended;
};

static ss_status
give_all(ss_source *s, double *const column[], size_t max, size_t *n, ss_error *err)
{
    struct changing *c = (struct changing *)s;
    (void)err;
    assert_true(max >= ROWS);
    *n = c->ended ? 0 : ROWS;
    memcpy(column[0], c->now, *n * sizeof *c->now);
    c->ended = 1;
    return SS_OK;
}

static void
change(ss_source *s)
{
    struct changing *c = (struct changing *)s;
    c->now = c->again;
    c->ended = 0;
}

/* Rows that are read again may have changed, in HDF5, too. */
static void
refuses_a_gap_that_was_not_there(void **state)
{
    enum { READINGS = 4 };
    static const struct source_calls calls = { .next = give_all, .rewind = change };
    static const double first[ROWS] = { 1, NAN, 3, 4 };
    static const double again[READINGS][ROWS] = { { 1, NAN, 3, 4 }, { NAN, 2, 3, 4 }, { 1, NAN, NAN, 4 },
                                                  { 1, 2, 3, NAN } };
    (void)state;
    for (int k = 0; k < READINGS; k++) {
        double value[ROWS], *column = value;
        size_t n;
        struct changing *c = ss_source_new(sizeof *c, &calls, "rows", NULL);
        ss_source *s = &c->base;
        c->now = first;
        c->again = again[k];
        s->head->rate = 10;
        assert_int_equal(ss_header_add_column(s->head, "x", NULL, NULL), SS_OK);
        assert_int_equal(ss_source_fill_gaps(&s, SS_GAPS_INTERPOLATE, NULL), SS_OK);
        assert_int_equal(ss_source_rows(s, &column, ROWS, &n, NULL), k == 0 ? SS_OK : SS_EDATA);
        assert_true(k > 0 || (n == ROWS && value[1] == 2));
        ss_source_free(s);
    }
}

/* Rows are given with their own times, at any spacing; a span is one of these times. */
static void
gives_each_row_its_stamp(void **state)
{
    static const struct { const char *text; double from, to; size_t n; double t[4], x[4]; } row[] = {
        { "t_ms,x\n0,1\n10,2\n35,4\n36,5\n", 0, 0, 4, { 0, .010, .035, .036 }, { 1, 2, 4, 5 } },
        { "t_ms,x\n0,1\n10,2\n35,4\n36,5\n", .01, .036, 2, { .010, .035 }, { 2, 4 } },
        { "x,time\n1,5\n2,5.5\n3,6.5\n", 5.5, 9, 2, { 5.5, 6.5 }, { 2, 3 } },
        { "# stickslip signal 1\n# rate: 4\n# start: 3\n# columns: t/s x\n3\t7\n3.25\t8\n", 3.1, 4, 1, { 3.25 },
          { 8 } } };
    (void)state;
    for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
        const ss_read_opts opts = { READ_OPTS, .stamps = 1, .from = row[k].from, .to = row[k].to };
        ss_signal *s = read_text(row[k].text, &opts);
        assert_int_equal(s->n, row[k].n);
        assert_int_equal(s->head->n_columns, 2);
        for (size_t i = 0; i < s->n; i++) {
            assert_true(s->values[i] == row[k].x[i]);
            assert_true(fabs(s->values[s->n + i] - row[k].t[i]) <= 1e-15);
        }
        ss_signal_free(s);
    }
    ss_signal *s = NULL;
    assert_int_equal(read_bytes(&s, "t,x\n0,1\n0,2\n", 12, &(ss_read_opts){ READ_OPTS, .stamps = 1 }, NULL), SS_ECLOCK);
    assert_null(s);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reads_tables_as_recorders_write_them),
        cmocka_unit_test(warns_of_what_is_guessed_or_left_out),
        cmocka_unit_test(refuses_what_it_cannot_know),
        cmocka_unit_test(reads_one_of_several_tables),
        cmocka_unit_test(calibrates_and_cuts),
        cmocka_unit_test(finds_the_exact_rate_behind_rounded_stamps),
        cmocka_unit_test(allows_stamps_a_tenth_of_a_period_off),
        cmocka_unit_test(refuses_options_that_a_clock_excludes),
        cmocka_unit_test(reads_the_measured_recordings),
        cmocka_unit_test(interpolates_uneven_stamps_to_a_uniform_clock),
        cmocka_unit_test(a_long_record_is_interpolated_as_by_one_spline),
        cmocka_unit_test(reads_a_file_as_it_reads_a_pipe),
        cmocka_unit_test(fills_the_gaps_of_a_long_table),
        cmocka_unit_test(reads_a_file_as_it_was_at_first),
        cmocka_unit_test(refuses_a_gap_that_was_not_there),
        cmocka_unit_test(gives_each_row_its_stamp),
    };
    return cmocka_run_group_tests_name("signal tables", tests, NULL, NULL);
}
