# Headers as recorders and their programs write them, by hand after their manuals and exports.
printf 'LabVIEW Measurement\t\nWriter_Version\t2\nReader_Version\t2\nSeparator\tTab\nDecimal_Separator\t.
Multi_Headings\tNo\nX_Columns\tOne\nTime_Pref\tRelative\nOperator\trig\nDate\t2020/03/05\nTime\t10:12:13.5
***End_of_Header***\t\n\t\nChannels\t2\t\t\nSamples\t3\t3\t\nDate\t2020/03/05\t2020/03/05\t
Y_Unit_Label\tNewton\tm/s^2\t\nX_Dimension\tTime\tTime\t\nX0\t0.0000000000000000E+0\t0.0E+0\t
Delta_X\t0.000500\t0.000500\t\n***End_of_Header***\t\t\t\nX_Value\tforce\taccel\tComment
0.000000\t1.5\t0.25\t\n0.000500\t1.25\t0.5\t\n0.001000\t1\t0.75\t\n' > labview.lvm
printf 'Time,Channel A,Channel B\r\n(ms),(V),(mV)\r\n\r\n-1.00000000,0.50000000,12.00000000\r
-0.50000000,0.25000000,\342\210\236\r\n0.00000000,0.00000000,14.00000000\r\n' > picoscope.csv
printf 'X,CH1,CH2,Start,Increment,\r\nSequence,Volt,Volt,-6.000000e-03,5.000000e-06\r\n0,1.04e+00,-2.0e-02,\r
1,1.00e+00,-1.0e-02,\r\n2,9.6e-01,0.0e+00,\r\n' > rigol.csv
printf 'Time(s),CH1(V)\n-0.006,1.04\n-0.005,1\n' > rigol-new.csv
printf 'Record Length,Analog:3\nSample Interval,Analog:0.000002000\nVertical Units,CH1:V
Vertical Scale,CH1:1.00\nVertical Offset,CH1:0.00000\nHorizontal Units,s\nHorizontal Scale,0.001
Model Number,SDS1104X-E\nSerial Number,SDSMMXXX\nSoftware Version,8.1.6.1.35R2\nSource,CH1\nSecond,Volt
-0.0000020000,0.04000\n-0.0000000000,0.08000\n0.0000020000,0.12000\n' > siglent.csv
printf '\357\273\277Data file: rig_0001.dxd\r\nStart time: 05.03.2020 10:12:13,125\r\nNumber of channels: 2\r
Sample rate: 1000\r\nStore type: always fast\r\n\r\nTime (s);AI 1 acc (m/s2);AI 2 force (N)\r
0,000000;0,125;1,28\r\n0,001000;0,250;1,27\r\n0,002000;0,375;1,26\r\n' > dewesoft.csv
printf 't,x,"f (N)"\n0,0.00012345678901235,1.28\n0.0004,NaN,1.28\n0.0008,0.000125,-1.28\n' > matlab.csv

for file in labview.lvm rigol.csv rigol-new.csv siglent.csv dewesoft.csv; do
    echo "-- $file"
    ss-cat "$file"
done
echo '-- picoscope.csv, matlab.csv'
for file in picoscope.csv matlab.csv; do
    ss-cat "$file" || echo $?
    ss-cat --gaps=interpolate "$file"
done
