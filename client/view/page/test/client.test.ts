import { create, fromBinary, type MessageInitShape, toBinary } from '@bufbuild/protobuf';
import { afterEach, beforeEach, expect, test, vi } from 'vitest';
import { Client, type Listener, type Transport } from '../src/connection/client';
import { EnvelopeSchema, Error_Code } from '../src/gen/haptic/v1/control_pb';

class FakeTransport implements Transport {
  onopen = () => undefined;
  onmessage: (data: Uint8Array) => void = () => undefined;
  onclose: (code: number, reason: string) => void = () => undefined;
  opened: string[] = [];
  sent: Uint8Array[] = [];
  closed = 0;

  open(url: string): void {
    this.opened.push(url);
  }
  send(data: Uint8Array): void {
    this.sent.push(data);
  }
  close(): void {
    this.closed += 1;
  }
  say(body: NonNullable<MessageInitShape<typeof EnvelopeSchema>['body']>): void {
    this.onmessage(toBinary(EnvelopeSchema, create(EnvelopeSchema, { body })));
  }
}

let transport: FakeTransport;
let listener: { [Name in keyof Listener]: ReturnType<typeof vi.fn> };
let client: Client;

beforeEach(() => {
  vi.useFakeTimers();
  transport = new FakeTransport();
  listener = { greeted: vi.fn(), frame: vi.fn(), event: vi.fn(), gap: vi.fn(), refused: vi.fn(), lost: vi.fn(), connecting: vi.fn() };
  client = new Client(transport, 'ws://x/ws', listener);
  client.connect();
});
afterEach(() => vi.useRealTimers());

const idOf = (data: Uint8Array | undefined): bigint => {
  const { body } = fromBinary(EnvelopeSchema, data ?? new Uint8Array());
  return body.case === 'request' ? body.value.id : -1n;
};

test('an answer finds its question, in any order', async () => {
  const first = client.call({ case: 'getStatus', value: {} }, 'status');
  const second = client.call({ case: 'arm', value: {} }, 'done');
  const [a, b] = transport.sent.map(idOf);
  transport.say({ case: 'response', value: { id: b as bigint, result: { case: 'done', value: {} } } });
  transport.say({ case: 'response', value: { id: a as bigint, result: { case: 'status', value: { scene: 'demo' } } } });
  expect((await first).scene).toBe('demo');
  await second;
});

test('a refusal has the words of the daemon', async () => {
  const call = client.call({ case: 'arm', value: {} }, 'done');
  transport.say({ case: 'response', value: { id: idOf(transport.sent[0]), error: { code: Error_Code.REFUSED, message: 'you may only look' } } });
  await expect(call).rejects.toMatchObject({ code: Error_Code.REFUSED, message: 'you may only look' });
});

test('of answers that nobody waits for only refusals are told', () => {
  transport.say({ case: 'response', value: { id: 99n, result: { case: 'done', value: {} } } });
  expect(listener.refused).not.toHaveBeenCalled();
  transport.say({ case: 'response', value: { id: 99n, error: { code: Error_Code.REFUSED, message: 'another client moves it' } } });
  expect(listener.refused).toHaveBeenCalledWith('another client moves it');
});

test('a lost connection ends open calls and is tried again, less and less often', async () => {
  const call = client.call({ case: 'getStatus', value: {} }, 'status');
  transport.onclose(1006, '');
  await expect(call).rejects.toMatchObject({ code: Error_Code.FAILED });
  expect(listener.lost).toHaveBeenLastCalledWith('the connection was closed', 0.5);
  for (const retry of [1, 2, 4, 8, 8]) {
    vi.advanceTimersByTime(8000);
    transport.onclose(1006, '');
    expect(listener.lost).toHaveBeenLastCalledWith('the connection was closed', retry);
  }
  vi.advanceTimersByTime(8000);
  transport.say({ case: 'hello', value: { major: 1 } });
  transport.onclose(1006, '');
  expect(listener.lost).toHaveBeenLastCalledWith('the connection was closed', 0.5);
});

test('why the daemon cut the page off is told', () => {
  transport.say({ case: 'goodbye', value: { error: { message: 'too many clients' } } });
  transport.onclose(1000, '');
  expect(listener.lost).toHaveBeenLastCalledWith('too many clients', 0.5);
});

test('a message that cannot be read ends the connection', () => {
  transport.onmessage(Uint8Array.from([0x0a, 0x7f, 1]));
  expect(transport.closed).toBe(1);
});
