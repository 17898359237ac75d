// Reads an MCAP file with Foxglove's own reader, checksums included, and prints what it holds.
// usage: node read.mjs FOLDER_OF_NODE_MODULES FILE
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';

const require = createRequire(`${process.argv[2]}/`);
const { McapIndexedReader, McapStreamReader } = require('@mcap/core');
const content = new Uint8Array(readFileSync(process.argv[3]));
const counts = {};
const payloads = {};

const readable = {
  size: async () => BigInt(content.length),
  read: async (offset, size) => content.slice(Number(offset), Number(offset + size)),
};
const indexed = await McapIndexedReader.Initialize({ readable });
for await (const message of indexed.readMessages({ validateCrcs: true })) {
  const { topic } = indexed.channelsById.get(message.channelId);
  counts[topic] = (counts[topic] ?? 0) + 1;
  (payloads[topic] ??= []).push(
    [String(message.logTime), String(message.publishTime), Buffer.from(message.data).toString('hex')]);
}

const stream = new McapStreamReader({ validateCrcs: true });
stream.append(content);
const streamed = {};
const names = {};
for (let record = stream.nextRecord(); record; record = stream.nextRecord()) {
  if (record.type === 'Channel') names[record.id] = record.topic;
  if (record.type === 'Message') {
    const topic = names[record.channelId];
    streamed[topic] = (streamed[topic] ?? 0) + 1;
  }
}
console.log(JSON.stringify({
  profile: indexed.header.profile,
  counts,
  streamed,
  finished: stream.done(),
  payloads,
  schemas: Object.fromEntries([...indexed.channelsById.values()].map(
    (channel) => [channel.topic, indexed.schemasById.get(channel.schemaId).name])),
}));
