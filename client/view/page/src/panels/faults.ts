// The faults since the daemon's start, the latest first, and where what came before them is recorded.
import type { FaultList_FaultRecord } from '../gen/haptic/v1/control_pb';
import { wordsOfFault } from '../model/words';
import { h } from './dom';

const SHOWN = 20;

export class FaultsPanel {
  readonly list = h('ol', { class: 'fault-list' });

  /** Nothing: the daemon does not tell them. */
  show(records: FaultList_FaultRecord[] | undefined): void {
    const items = (records ?? [])
      .slice(-SHOWN)
      .reverse()
      .flatMap((record) => {
        if (!record.fault) return [];
        const { title, detail } = wordsOfFault(record.fault);
        const at = new Date(Number(record.realtimeNs / 1_000_000n));
        return [
          h(
            'li',
            { class: record.latched ? 'latched' : '' },
            h('span', { class: 'quiet num' }, `${at.toLocaleTimeString()}  `),
            h('strong', {}, title),
            h('span', { class: 'quiet' }, ` ${detail}${record.latched ? ' · latched' : ''}`),
            record.recording === '' ? undefined : h('code', { title: 'a recording on the daemon\u2019s machine' }, record.recording),
          ),
        ];
      });
    const none = records ? 'None since the daemon\u2019s start.' : 'This daemon keeps no list of faults.';
    this.list.replaceChildren(...(items.length > 0 ? items : [h('li', { class: 'quiet' }, none)]));
  }
}
