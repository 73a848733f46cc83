// Eyebox photodiode: the ADC of an Arduino UNO (ATmega328P), read by the host over USB serial.
//
// A0      amplifier of the photodiode, 0 to 5 V
// pin 2   input, pulled up: with a period of 0 each rising edge starts one conversion
//
// Conversions are started by Timer1 (every period_us) or by the pulse; the interrupt at their end
// puts time and counts into a ring, loop() sends it. A conversion that finds the ring full is lost
// and still numbered, so that the host sees it. The frames are described in ../README.md.

#include <util/crc16.h>

const uint32_t kBaud = 500000;
const uint8_t kPulsePin = 2;
const uint8_t kProtocol = 1;
const uint8_t kBits = 10;
// A conversion takes 26 us at 500 kHz ADC clock; 200 us keep the wire less than half full.
const uint32_t kMinimumPeriodUs = 200;
const uint32_t kMaximumPeriodUs = 60000000;
const uint8_t kMaxSamples = 16;
const uint32_t kFlushAfterUs = 5000;  // a frame waits this long at most for more samples

// ---- conversions

struct Sample {
  uint32_t sequence;
  uint32_t micros;
  uint16_t counts;
};

const uint8_t kRingSize = 64;  // a power of two
volatile Sample ring[kRingSize];
volatile uint8_t ringHead = 0;  // next to write, by the interrupt
volatile uint8_t ringTail = 0;  // next to read, by loop()
volatile uint32_t conversions = 0;  // begun or due
volatile uint32_t startedUs = 0;    // of the one under way
volatile uint32_t startedSequence = 0;
volatile bool running = false;
volatile uint32_t ticksLeft = 0;  // Timer1 periods until the next conversion
uint32_t periodUs = 1000;
uint32_t ticksPerPeriod = 1;

void startConversion() {
  if (!running) return;
  const uint32_t sequence = conversions++;
  if (ADCSRA & _BV(ADSC)) return;  // the one before has not ended: this one is lost
  startedSequence = sequence;
  startedUs = micros();
  ADCSRA |= _BV(ADSC);
}

ISR(TIMER1_COMPA_vect) {
  if (--ticksLeft > 0) return;
  ticksLeft = ticksPerPeriod;
  startConversion();
}

ISR(ADC_vect) {
  const uint16_t counts = ADC;
  const uint8_t next = (ringHead + 1) & (kRingSize - 1);
  if (next != ringTail) {
    ring[ringHead].sequence = startedSequence;
    ring[ringHead].micros = startedUs;
    ring[ringHead].counts = counts;
    ringHead = next;
  }
}

// Timer1 counts half microseconds up to a whole divisor of the period, at most 32 ms: the period is
// then exact however long it is. Periods without such a divisor are refused.
bool setPeriod(uint32_t us) {
  if (us == 0) {
    periodUs = 0;
    return true;
  }
  if (us < kMinimumPeriodUs || us > kMaximumPeriodUs) return false;
  uint32_t ticks = (us + 31999) / 32000;
  while (ticks <= us / 100 && us % ticks != 0) ++ticks;
  if (us % ticks != 0) return false;
  periodUs = us;
  ticksPerPeriod = ticks;
  return true;
}

void stopConversions() {
  running = false;
  detachInterrupt(digitalPinToInterrupt(kPulsePin));
  TIMSK1 = 0;
  while (ADCSRA & _BV(ADSC)) {
  }
}

void startConversions() {
  stopConversions();
  noInterrupts();
  conversions = 0;
  ringHead = ringTail = 0;
  running = true;
  if (periodUs > 0) {
    TCCR1A = 0;
    TCCR1B = _BV(WGM12) | _BV(CS11);  // clear on compare, 16 MHz / 8
    OCR1A = (uint16_t)(2 * (periodUs / ticksPerPeriod) - 1);
    TCNT1 = 0;
    ticksLeft = ticksPerPeriod;
    TIFR1 = _BV(OCF1A);
    TIMSK1 = _BV(OCIE1A);
  } else {
    EIFR = _BV(INTF0);
    attachInterrupt(digitalPinToInterrupt(kPulsePin), startConversion, RISING);
  }
  interrupts();
}

// ---- frames

uint8_t payload[10 + 4 * kMaxSamples + 2];
uint8_t payloadSize = 0;

void put8(uint8_t value) { payload[payloadSize++] = value; }
void put16(uint16_t value) {
  put8(value & 0xff);
  put8(value >> 8);
}
void put32(uint32_t value) {
  put16(value & 0xffff);
  put16(value >> 16);
}

uint16_t crcOf(const uint8_t* bytes, uint8_t size) {
  uint16_t crc = 0xffff;
  for (uint8_t i = 0; i < size; ++i) crc = _crc_xmodem_update(crc, bytes[i]);
  return crc;
}

// Appends the CRC and sends the payload byte-stuffed: each group is its length plus one, then its
// bytes, none of them zero.
void sendPayload() {
  put16(crcOf(payload, payloadSize));
  uint8_t begin = 0;
  for (uint8_t at = 0; at <= payloadSize; ++at) {
    if (at < payloadSize && payload[at] != 0) continue;
    Serial.write((uint8_t)(at - begin + 1));
    Serial.write(payload + begin, at - begin);
    begin = at + 1;
  }
  Serial.write((uint8_t)0);
  payloadSize = 0;
}

void sendState(uint8_t token, uint32_t readUs) {
  payloadSize = 0;
  put8(0x02);
  put8(token);
  put8(kProtocol);
  put8(kBits);
  put8(running ? 1 : 0);
  put32(periodUs);
  put32(kMinimumPeriodUs);
  put32(readUs);
  sendPayload();
}

Sample ringAt(uint8_t index) {
  Sample sample;
  sample.sequence = ring[index].sequence;
  sample.micros = ring[index].micros;
  sample.counts = ring[index].counts;
  return sample;
}

// Samples from the tail that follow each other without a gap and fit one frame.
uint8_t consecutive() {
  uint8_t count = 0;
  Sample last;
  for (uint8_t at = ringTail; at != ringHead && count < kMaxSamples;
       at = (at + 1) & (kRingSize - 1)) {
    const Sample sample = ringAt(at);
    if (count > 0 && (sample.sequence != last.sequence + 1 || sample.micros - last.micros > 65535)) {
      break;
    }
    last = sample;
    ++count;
  }
  return count;
}

void sendSamples(uint8_t count) {
  uint32_t lastUs = ringAt(ringTail).micros;
  payloadSize = 0;
  put8(0x01);
  put8(count);
  put32(ringAt(ringTail).sequence);
  put32(lastUs);
  for (uint8_t i = 0; i < count; ++i) {
    const Sample sample = ringAt(ringTail);
    put16((uint16_t)(sample.micros - lastUs));
    put16(sample.counts);
    lastUs = sample.micros;
    ringTail = (ringTail + 1) & (kRingSize - 1);
  }
  sendPayload();
}

// ---- requests

uint8_t request[16];
uint8_t requestSize = 0;
bool requestOverlong = false;

// In place; returns the size without CRC, 0 if the frame is damaged.
uint8_t unstuffRequest() {
  uint8_t size = 0;
  for (uint8_t at = 0; at < requestSize;) {
    const uint8_t code = request[at];
    if (code == 0 || at + code > requestSize) return 0;
    if (at > 0) request[size++] = 0;
    for (uint8_t i = 1; i < code; ++i) request[size++] = request[at + i];
    at += code;
  }
  if (size < 4) return 0;
  const uint16_t crc = request[size - 2] | (uint16_t)request[size - 1] << 8;
  return crc == crcOf(request, size - 2) ? size - 2 : 0;
}

void handleRequest(uint32_t readUs) {
  const uint8_t size = unstuffRequest();
  if (size == 0) return;
  const uint8_t type = request[0];
  if (type == 0x11 && size == 6) {
    const uint32_t us = request[2] | (uint32_t)request[3] << 8 | (uint32_t)request[4] << 16 |
                        (uint32_t)request[5] << 24;
    if (!running) setPeriod(us);  // what was not taken shows in the answer
  } else if (size != 2) {
    return;
  } else if (type == 0x12) {
    startConversions();
  } else if (type == 0x13) {
    stopConversions();
  } else if (type != 0x10) {
    return;
  }
  sendState(request[1], readUs);
}

void readRequests() {
  while (Serial.available() > 0) {
    const uint8_t byte = Serial.read();
    if (byte != 0 && requestSize < sizeof request) {
      request[requestSize++] = byte;
    } else if (byte != 0) {
      requestOverlong = true;
    } else {
      if (!requestOverlong) handleRequest(micros());
      requestSize = 0;
      requestOverlong = false;
    }
  }
}

void setup() {
  Serial.begin(kBaud);
  pinMode(kPulsePin, INPUT_PULLUP);
  ADMUX = _BV(REFS0);  // 5 V reference, A0
  DIDR0 = _BV(ADC0D);
  // ADC clock 16 MHz / 32: 500 kHz costs less than one of 10 bits.
  ADCSRA = _BV(ADEN) | _BV(ADIE) | _BV(ADPS2) | _BV(ADPS0);
}

void loop() {
  readRequests();
  const uint8_t count = consecutive();
  if (count == 0) return;
  const bool waited = micros() - ringAt(ringTail).micros > kFlushAfterUs;
  if (count == kMaxSamples || waited) sendSamples(count);
}
