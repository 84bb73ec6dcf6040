/* A small program for the ATmega328P that uses every pin the test bed offers: it shows that the bed is right, not the
 * firmware. Each byte that comes in is a command: 'p' + byte sets the PWM at PD5, 'c' tells the left encoder's count
 * as two bytes, 'a' the ADC's channel 0 in 10 bits as two bytes, 'r' the reset cause, 'd' starts the watchdog
 * (it bites after 120 ms), any other is sent back. PB1 has a pulse of 1500 µs every 20 ms; PB0 is high. */
#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/wdt.h>

static volatile int16_t count;
static uint8_t cause;

ISR(INT0_vect) { count += (PIND >> 2 & 1) == (PINC >> 4 & 1) ? -1 : 1; }
ISR(TIMER1_COMPA_vect) { PORTB |= 2; }
ISR(TIMER1_COMPB_vect) { PORTB &= ~2; }

static uint8_t get(void) {
  while (!(UCSR0A & 1 << RXC0)) wdt_reset();
  return UDR0;
}
static void tell(uint8_t byte) {
  while (!(UCSR0A & 1 << UDRE0)) continue;
  UDR0 = byte;
}
static void tell_word(uint16_t word) { tell(word), tell(word >> 8); }

static void start(void) {
  cause = MCUSR, MCUSR = 0, wdt_disable();
  UCSR0A = 1 << U2X0, UBRR0 = 16, UCSR0B = 1 << RXEN0 | 1 << TXEN0; /* 115200 */
  DDRD = 1 << 5, DDRB = 3, PORTB = 1;
  TCCR0A = 1 << COM0B1 | 3, TCCR0B = 3; /* fast PWM, 1.024 ms */
  TCCR1A = 0, TCCR1B = 1 << WGM12 | 2; /* 20 ms of half microseconds */
  OCR1A = 39999, OCR1B = 2999, TIMSK1 = 1 << OCIE1A | 1 << OCIE1B;
  EICRA = 1, EIMSK = 1; /* each edge of PD2 */
  ADMUX = 1 << REFS0, ADCSRA = 1 << ADEN | 7;
  sei();
}

static uint16_t measure(void) {
  ADCSRA |= 1 << ADSC;
  while (ADCSRA & 1 << ADSC) continue;
  return ADC;
}

static uint16_t counted(void) {
  cli();
  uint16_t value = count;
  sei();
  return value;
}

int main(void) {
  start();
  for (;;) {
    uint8_t command = get();
    if (command == 'p') OCR0B = get();
    else if (command == 'c') tell_word(counted());
    else if (command == 'a') tell_word(measure());
    else if (command == 'r') tell(cause);
    else if (command == 'd') wdt_enable(WDTO_120MS);
    else tell(command);
  }
}
