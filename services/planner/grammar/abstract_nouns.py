"""Nouns of what cannot be carried: `bring me luck` asks for nothing that could be found. Pure.

Those single words of WordNet 3.0 (Princeton University, 2006; wordnet.princeton.edu/license-and-commercial-use) that
are counted four times or more in its tagged texts and whose senses are all acts, attributes, cognitions, events,
feelings, states, times and the like, and words that are such where somebody is asked for them (`give me a hand`).
"""

_WORDS = """
abandon abandonment ability absence absorption absurdity acceleration accent accident accomplishment accordance
accreditation accuracy achievement acquiescence acreage acting activity actuality adjective admiration advantage
adventure advertising advice aeration affair affairs affection affiliation afternoon age agglutination
aggression aggressiveness agony agreement ailment aim allusion alteration altercation alternative amazement
ambiguity ambition ambush amendment amplitude amusement analogy anecdote anger anguish anniversary announcement
answer antagonism anticipation anxiety appeal appearance appetite applause appreciation apprehension approval
approximation april argument arithmetic arrangement arrest arts aspect assent assistance assumption astonishment
athabascan atrophy attack attempt attention attitude aug august authenticity authority autumn average avoidance
awareness awe badge badness ballet basis battle beauty beginning behalf behavior being belief birthday
bitterness blackness blame blaze blindness bloat blot blur booking boost boredom boyhood breadth break breakdown
breathing breeze brightness brutality bulk burial bus calculation calibration call campaign camping cancer
capability capacity care career catastrophe catharsis catholicism cause caution celebration century ceremony
certainty challenge chance chaos characteristic characterization checklist cheer cheering childhood chill choice
chore christianity christmas chromatography circulation circumstance claim clamor clarity clatter cleaning
cliche climate climax climb clue coefficient cohesion coincidence cold collaboration collapse collision color
colour combat comedy coming command comment commentary commerce commercial commitment commotion communication
comparison competence competition complaint complement completion complexity complication complicity compliment
comprehension compromise compulsion compulsivity computation concentration concept conception concern concert
conclusion condemnation condition conduct confidence confirmation conflict conformity confusion congratulation
connotation conscience consciousness consent consequence conservatism consistency consonant constant
consultation contemplation contempt contention contest context continuity contraception contradiction contrast
controversy conversation conversion conviction cooking cooperation correlation correspondence counseling courage
crash credo crime crisis criterion cruelty cry curriculum curse dance dancing danger darkness datum dawn day
daylight death debate debut decade decay december decency decision decomposition decrease dedication defeat
defect defiance deficiency definition degree delay delight demand demonstration demythologization denial density
departure dependence depravity depth derision description desire despair desperation destruction detail
detection determination development diagnosis dialect dialectic dialysis diameter diarrhea dictionary difference
differentiation difficulty diffusion dignity dilemma dimension din disagreement disappearance disappointment
disapproval disaster discipline discontinuity discovery discrepancy discretion discrimination discussion disease
dislike dismay disobedience disorder dispatch displacement dispute distance distinction distress distribution
disturbance diversion divorce doctrine documentary dominance domination double doubt dozen dream drinking
drizzle drought duration dusk eagerness earthquake easy editorial education effect effectiveness efficacy
efficiency effort ego election electricity electronics elution embarrassment emotion emphasis employment
encounter encouragement endeavor endurance english enjoyment enough entertainment enthusiasm environment
epidemic epoch equation equivalent era errand error escalation eternity evaluation evening evidence evil
evolution examination example exasperation exception excess excitability excitement exclamation excuse exercise
exertion expansion expectation experience experiment experimentation explanation exploitation exploration
explosion expression extent eyes fact factor failure faith fame familiarity farewell farming fatigue favor
favour fear feat feb february feeding feel feelings fever fibrosis fight fighting finance financing firing
fishing fit fitness flame flatness flavor flexibility flow fluorescence flurry flux fog folklore footstep force
fractionation freedom frenzy frequency friday frustration fulfillment fun function funeral fusion futility
gaiety gambling gasp gaze generalization gesture glance glare gleam glimpse gloom glory glow golf goodness
gradient grandeur graph gratification greatness greeting grief grin grip growth guidance guilt gunfire
gymnastics half hand handful handling hands hang happiness harm harmony haste hate hatred haze headache health
hearing height help hemorrhage hesitation history hobby holiday homer homogeneity honor honour hope horses hour
hours howl hue hug humiliation humour hunch hundred hunger hunting hurry hurt hymn hypothesis idea
identification identity ideology idiom ignorance illness illusion imagery imagination immediacy immortality
immunity impact impatience implication importance imprecation improvement impulse inability inch incidence
incident incitement increase independence indication indifference indignation individualism induction infection
inference infiltration influence information inhibition initiative injury inning innocence inquiry insight
insinuation insistence inspection instance instant instinct instruction integer integration integrity intensity
intent intention interaction interdependence interlude interpretation interrelation interruption interval
interview intonation introject intuition invasion investigation involvement irony irregularity irritation
isolation january jazz job joke journalism journey joy july june justice justification ketosis kick kill kiss
lack lapse laugh laughter laurels lead leap learning lecture legislation leisure lessening lesson
lexicostatistics liberalism liberty lie life lift lightning liking limit limitation list liter little logic
loneliness longing look lookup lore lost lots love loyalty luck lull luxury magic magnetism magnitude majority
malaise management maneuver manifestation manner manners march marketing marriage mastery mathematics matter
maturity may mean meaning measurement mechanics medal meet melody menace menarche mention mercy merger merit
message method micron microsecond midnight mile millennium millidegree milligram million mimesis mind minute
miracle misery misfortune misgiving mist mistake mixing mode modernity modulation moisture moment momentum
monday monitoring monopoly month mood moonlight morale morality morning morphophonemics mortality motion move
movie much multiplicity murder mystery name nap narrative nationalism neglect nerves neurosis neutralism news
night nightfall nightmare noise nonfiction noon norm nothing nov november now number oath objection obscurity
observation occasion occupation occurrence october odor offer omission one onset onslaught operation operator
operetta opportunity orchestration order organification originality ossification outburst outcome outlook
outreach outset overture oxidation pace page pain pains panic paradigm parking participation particular party
passing passion past patience pause peace penetration percent perception perfection performance period
permission persistence personality perspective petition phase philosophy phonology phrase physics pitching pity
placement planning playing pleasure plenty plight plumpness poetry polarity polarization politics polynomial
popularity possession possibility posture potential potentiality poverty practice praise preaching precaution
precision preference presence pressure prestige prevention prevision principle priority privilege probability
problem procedure proceedings procession proclamation procreation procurement productivity profile progress
project promise promotion pronoun propaganda proposal proposition prospect prosperity protest protestantism
psychology publication publicity punishment purity purpose pursuit pushup quackery qualification quality quantum
question questioning race rage rating ratio reaction reactivity readiness reading reality realization reason
reasoning reassurance rebellion receipt recognition recollection recommendation recovery recreation recruitment
reduction reflex reform refusal regard regret regulation rehabilitation rehearsal rejection relations
relationship relevance religion remark removal renaissance repetition reply reproach reputation request research
resemblance resentment resonance respect respite response responsibility rest restatement restriction result
resume retailing retention retirement revenge revolt revolution rhythm richness ride ripple risk rite ritual
roar role roleplaying roughness rpm rule rules ruling rumor run running rushing rustling sailing sale salvation sample
sampling satire saturday saving scandal scar scent schedule scheme science score scorn scours scream scrutiny
search season seat secret seizure selection self selling sending sensation sense sensibility sensitivity
sentence sentiment september sermon service services session sex shadow shame shape shooting shortage shot
shouting show shriek shutdown sickness sigh sight sign signal significance silence similarity simplicity sin
sincerity singing single situation sixties size skill slaughter slavery sleep smell smile socialism solidarity
somersault sorrow sort sound specialization specificity spectrum speech spell splendor sport spree springtime
stability staining standpoint stare start statement statistic stature status stereotype stillness stimulation
stimulus stoicism storm story strategy strength stress stride strife strike struggle stupidity success suffering
suggestion summary summer sunday sundown sunlight superiority superstition supervision supply supremacy surge
surplus surprise survey survival suspense suspicion syllable symbol sympathy symptom synthesis tactic tale
talent talk task teaching tears technique technology temper temperature temptation tendency tension terror test
testimony testing texture thanks then theology theorem theory therapy thickness thinking thought thousand threat
thrill thrust thursday tide time times timing titer today tomorrow ton topic toss touch touchdown tour
tournament trade trademark tradition tragedy training trance transfer transition travel treason treatment trial
tribute triumph trouble truth try tsunami tuberculosis tuesday tumor tune turmoil turn twenties twilight type
ulcer ultracentrifugation uncertainty understanding unity uproar uptake urge usage use usefulness utopia
vacation validity valor values vaudeville vector velocity verb vertex victory viewpoint vindication violation
violence virtue viscosity vision visit vitality vocabulary voice volley voltage vote voting voyage wait
wakefulness war warfare warmth warning wave wavelength way weakness weather wednesday week weekend welfare while
whisper width willingness winter wish wonder word workout worry worship wound wrath wrong year yearning years
yell yellow yes yesterday zeal
hello hi goodbye bye welcome wave wink cuddle cheers position positions stance seat spin twirl nod bow salute clap five
hike nap stroll shower bath guess selfie dive bite sip posture presentation rundown heads overview
"""
ABSTRACT: frozenset[str] = frozenset(_WORDS.split())
