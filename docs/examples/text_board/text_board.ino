// Prints one line a scan, time,count,count,..., for the driver's protocol text (docs/text_format.md):
//   roslaunch fsr_pressure_map driver.launch protocol:=text rows:=7 columns:=10 serial_port:=/dev/ttyACM0
// Arduino Mega 2560 and 7 x 10 taxels: row wires on pins 22 to 28, column wires on A0 to A9, and 10 kOhm from
// each column wire to ground. This simple divider has crosstalk between the taxels of a column.

const int ROWS = 7;
const int COLUMNS = 10;
const int FIRST_ROW_PIN = 22;
const unsigned int SETTLING_US = 50;  // from switching a row until its voltages are steady

int counts[ROWS * COLUMNS];  // row 0 first, and in each row column 0 first

void setup() {
  Serial.begin(115200);  // serial_baud
  for (int row = 0; row < ROWS; ++row) {
    pinMode(FIRST_ROW_PIN + row, OUTPUT);
    digitalWrite(FIRST_ROW_PIN + row, LOW);
  }
  Serial.println("# 7 x 10 taxels, time [ms] and counts of 10 bits");
}

void scan() {
  for (int row = 0; row < ROWS; ++row) {
    digitalWrite(FIRST_ROW_PIN + row, HIGH);
    delayMicroseconds(SETTLING_US);
    for (int column = 0; column < COLUMNS; ++column) counts[row * COLUMNS + column] = analogRead(A0 + column);
    digitalWrite(FIRST_ROW_PIN + row, LOW);
  }
}

void loop() {
  const unsigned long time = millis();  // or micros(), with text_time:=us
  scan();
  Serial.print(time);
  for (int i = 0; i < ROWS * COLUMNS; ++i) {
    Serial.print(',');
    Serial.print(counts[i]);
  }
  Serial.println();
}
